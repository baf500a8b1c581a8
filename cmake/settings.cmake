# Language, warnings and code generation, the same for every room.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release)
endif()

option(FATMC_TESTS "build tests and benchmarks" ON)
option(FATMC_OPENMP "use OpenMP where a room offers it" ON)
set(FATMC_SANITIZE "" CACHE STRING "sanitizers, for instance address,undefined")

# x86-64-v3 (AVX2, FMA) where the building machine has it; -DFATMC_MARCH= builds for the compiler's
# baseline. Never -ffast-math: it would let the compiler assume that no NaN exists.
set(FATMC_DEFAULT_MARCH "")
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64" AND EXISTS /proc/cpuinfo)
  file(STRINGS /proc/cpuinfo FATMC_CPU_FLAGS REGEX "^flags" LIMIT_COUNT 1)
  if(FATMC_CPU_FLAGS MATCHES " avx2 " AND FATMC_CPU_FLAGS MATCHES " fma " AND FATMC_CPU_FLAGS MATCHES " bmi2 ")
    set(FATMC_DEFAULT_MARCH "x86-64-v3")
  endif()
endif()
set(FATMC_MARCH "${FATMC_DEFAULT_MARCH}" CACHE STRING "value of -march")

add_library(fatmc_settings INTERFACE)
target_compile_options(fatmc_settings INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Werror
  -Wno-restrict)  # GCC 12 warns falsely inside std::string
if(FATMC_MARCH)
  target_compile_options(fatmc_settings INTERFACE -march=${FATMC_MARCH})
endif()
if(FATMC_SANITIZE)
  target_compile_options(fatmc_settings INTERFACE -fsanitize=${FATMC_SANITIZE} -fno-omit-frame-pointer -g)
  target_link_options(fatmc_settings INTERFACE -fsanitize=${FATMC_SANITIZE})
endif()
target_include_directories(fatmc_settings INTERFACE ${PROJECT_SOURCE_DIR})
set(CMAKE_CXX_FLAGS_RELEASE "-O3")

find_program(FATMC_CCACHE ccache)
if(FATMC_CCACHE)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${FATMC_CCACHE})
endif()
find_program(FATMC_MOLD mold)
if(FATMC_MOLD)
  add_link_options(-fuse-ld=mold)
endif()
