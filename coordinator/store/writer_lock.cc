#include "coordinator/store/writer_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

namespace fatmc {

// A file of its own, since closing any descriptor of the database would drop SQLite's POSIX locks on it.
Result<WriterLock> WriterLock::take(const std::string& database) {
  const std::string path = database + ".lock";
  for (;;) {
    const int descriptor = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
    if (descriptor < 0) {
      return fail(Error{database, 0, "",
                        std::string("cannot be written (") + std::strerror(errno) +
                            "), name a file in a folder that you may write to by --db"});
    }
    if (::flock(descriptor, LOCK_EX | LOCK_NB) != 0) {
      ::close(descriptor);
      return fail(
          Error{database, 0, "", "is being written by another coordinator, wait for it or stop it first"});
    }
    struct stat held {
    }, present{};
    // The former holder may have removed the file between our open and flock.
    if (::fstat(descriptor, &held) == 0 && ::stat(path.c_str(), &present) == 0 &&
        held.st_ino == present.st_ino) {
      return WriterLock(path, descriptor);
    }
    ::close(descriptor);
  }
}

WriterLock::WriterLock(WriterLock&& other) noexcept
    : path_(std::move(other.path_)), descriptor_(std::exchange(other.descriptor_, -1)) {}

WriterLock::~WriterLock() {
  if (descriptor_ < 0) return;
  ::unlink(path_.c_str());
  ::close(descriptor_);
}

}  // namespace fatmc
