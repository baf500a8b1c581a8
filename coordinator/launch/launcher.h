// Workers beyond this machine: whoever starts, counts and ends them.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace fatmc {

/// What a launcher goes by.
struct LaunchView {
  std::uint64_t left = 0;    ///< trials without a stored row
  std::uint64_t stored = 0;  ///< trials stored so far
  std::size_t workers = 0;   ///< connected worker processes
};

/// Single-threaded: all calls from the server's thread, and none of them waits but stop().
class Launcher {
 public:
  using Time = std::chrono::steady_clock::time_point;
  virtual ~Launcher() = default;
  /// To be called about ten times a second.
  virtual void tick(const LaunchView& view, Time now) = 0;
  /// Why no worker can be had any more; empty while they can.
  [[nodiscard]] virtual const std::string& failure() const = 0;
  /// Ends all workers (they were told BYE).
  virtual void stop(std::chrono::milliseconds patience) = 0;
};

/// What pilots and workers elsewhere are started with.
struct RemoteWorker {
  std::string program;   ///< path of fatmc-worker there
  std::string endpoint;  ///< as seen from there
  std::string keys;      ///< folder of keys as seen from there
  unsigned jobs = 1;     ///< trials at a time
  /// How long a worker waits for a coordinator that is gone, so that one that is started again finds it.
  std::chrono::seconds leave_after{300};
};

/// The command line for a shell.
std::string command_line(const RemoteWorker& worker);

/// One word of a shell, quoted where needed.
std::string shell_word(const std::string& word);

}  // namespace fatmc
