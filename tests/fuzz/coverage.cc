// Coverage for libFuzzer from GCC's -fsanitize-coverage=trace-pc: a counter a block, in the section that libFuzzer
// watches. Compiled without coverage itself; the linker puts it in the place of __sanitizer_cov_trace_pc (--wrap).
#include <cstdint>

namespace {

constexpr std::size_t kCounters = std::size_t{1} << 16;
__attribute__((section("__libfuzzer_extra_counters"), used)) std::uint8_t counters[kCounters];

}  // namespace

extern "C" __attribute__((no_sanitize("address", "undefined"))) void __wrap___sanitizer_cov_trace_pc() {
  const auto block = reinterpret_cast<std::uintptr_t>(__builtin_return_address(0));
  std::uint8_t& counter = counters[(block * 0x9E3779B97F4A7C15ULL) >> 48];  // Fibonacci hashing
  if (counter < 255) ++counter;
}
