// A short command as a child process: started, looked at now and then, never waited for.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <optional>
#include <string>
#include <vector>

namespace fatmc {

struct CommandResult {
  int exit_code = -1;  ///< 127 when it cannot be started, 128 + signal when a signal ended it
  std::string output;  ///< standard output
  std::string errors;  ///< standard error, its first line at most 200 characters long

  [[nodiscard]] bool ok() const { return exit_code == 0; }
};

class ChildCommand {
 public:
  using Time = std::chrono::steady_clock::time_point;
  ChildCommand() = default;
  ~ChildCommand();
  ChildCommand(const ChildCommand&) = delete;
  ChildCommand& operator=(const ChildCommand&) = delete;

  /// Starts argv[0], found on PATH, with `input` as its standard input. It is killed at `deadline`, since
  /// tools of a cluster wait for minutes when its controller is gone.
  void start(const std::vector<std::string>& arguments, const std::string& input, Time deadline);
  [[nodiscard]] bool running() const { return pid_ > 0; }
  /// The result, once, when the command has ended.
  std::optional<CommandResult> take(Time now);

 private:
  pid_t pid_ = -1;
  int output_ = -1, errors_ = -1;
  Time deadline_{};
  std::optional<CommandResult> early_;
};

/// Runs to the end, for places that may wait.
CommandResult run_command(const std::vector<std::string>& arguments, const std::string& input,
                          std::chrono::milliseconds patience);

}  // namespace fatmc
