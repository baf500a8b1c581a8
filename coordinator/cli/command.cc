#include "coordinator/cli/command.h"

#include <cstdio>

namespace fatmc::cli {

Exit report(const Error& error) {
  std::fprintf(stderr, "fatmc: %s\n", error.text().c_str());
  return Exit::wrong_use;
}

}  // namespace fatmc::cli
