// One writer a database: a lock file beside it (FILE.lock) that the kernel frees when its holder dies.
#pragma once

#include <string>

#include "core/base/error.h"

namespace fatmc {

class WriterLock {
 public:
  /// Fails at once when another process holds the lock.
  static Result<WriterLock> take(const std::string& database);
  WriterLock(WriterLock&& other) noexcept;
  WriterLock& operator=(WriterLock&& other) = delete;
  ~WriterLock();

 private:
  WriterLock(std::string path, int descriptor) : path_(std::move(path)), descriptor_(descriptor) {}
  std::string path_;
  int descriptor_;
};

}  // namespace fatmc
