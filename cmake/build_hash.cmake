# Writes OUTPUT (a C++ file) with the hash of this build. Run by core/base/CMakeLists.txt at build time:
#   cmake -D SOURCE_DIR=... -D OUTPUT=... -D BUILD=<compiler, version, flags> -P build_hash.cmake
# Covers C++ sources alone: specs, models and published figures are data, and a campaign carries its own.
file(GLOB_RECURSE files RELATIVE ${SOURCE_DIR}
  ${SOURCE_DIR}/core/*.h ${SOURCE_DIR}/core/*.cc ${SOURCE_DIR}/campaigns/*.h ${SOURCE_DIR}/campaigns/*.cc)
list(SORT files)
set(text "${BUILD}\n")
foreach(file IN LISTS files)
  file(SHA256 ${SOURCE_DIR}/${file} hash)
  string(APPEND text "${file} ${hash}\n")
endforeach()
string(SHA256 hash "${text}")
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT [[
#include "core/base/build_hash.h"

namespace fatmc {

std::string build_hash() { return "@hash@"; }

}  // namespace fatmc
]] @ONLY)
