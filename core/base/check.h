// A broken invariant of the program itself (never of its input) stops it, in release builds too.
#pragma once

namespace fatmc {

[[noreturn]] void invariant_broken(const char* condition, const char* file, int line, const char* why);

}  // namespace fatmc

#define FATMC_CHECK(condition, why)                                                     \
  do {                                                                                  \
    if (!(condition)) ::fatmc::invariant_broken(#condition, __FILE__, __LINE__, (why)); \
  } while (false)
