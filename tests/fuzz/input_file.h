// The bytes of a fuzzer as a file, for readers that take a path.
#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <cstdlib>
#include <string>
#include <string_view>

namespace fatmc {

/// A file in memory; /proc gives it a path.
class InputFile {
 public:
  InputFile() : descriptor_(::memfd_create("input", 0)) {
    if (descriptor_ < 0) std::abort();
  }
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;
  ~InputFile() { ::close(descriptor_); }
  void fill(std::string_view bytes) {
    if (::ftruncate(descriptor_, 0) != 0) std::abort();
    if (::pwrite(descriptor_, bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size()))
      std::abort();
  }
  [[nodiscard]] std::string path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

 private:
  int descriptor_;
};

/// An error says something, in one line, whatever the input.
inline void check_error(const std::string& text) {
  if (text.empty() || text.find('\n') != std::string::npos) std::abort();
}

}  // namespace fatmc
