// An open file descriptor with one owner.
#pragma once

#include <unistd.h>

#include "core/base/check.h"

namespace fatmc {

/// A descriptor that closes itself.
class Descriptor {
 public:
  explicit Descriptor(int value) : value_(value) { FATMC_CHECK(value >= 0, "out of file descriptors"); }
  ~Descriptor() { ::close(value_); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  [[nodiscard]] int get() const { return value_; }

 private:
  int value_;
};

}  // namespace fatmc
