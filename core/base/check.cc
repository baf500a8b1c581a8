#include "core/base/check.h"

#include <cstdio>
#include <cstdlib>

namespace fatmc {

void invariant_broken(const char* condition, const char* file, int line, const char* why) {
  std::fprintf(stderr, "fatmc: internal error: %s (%s) at %s:%d\n", why, condition, file, line);
  std::abort();
}

}  // namespace fatmc
