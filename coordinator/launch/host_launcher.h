// One worker a host, each behind a line of a shell: ssh, or whatever starts a command elsewhere.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "coordinator/launch/child_command.h"
#include "coordinator/launch/launcher.h"
#include "core/base/error.h"

namespace fatmc {

struct Host {
  std::string name;   ///< as ssh takes it: host, user@host, an alias of its configuration
  unsigned jobs = 1;  ///< trials at a time
  bool operator==(const Host&) const = default;
};

/// "node1,ada@node2:4"
Result<std::vector<Host>> parse_hosts(const std::string& text);

struct HostOptions {
  RemoteWorker worker;  ///< `jobs` is each host's own
  std::vector<Host> hosts;
  /// {host} and {command} stand for the host's name and the worker's command line, each as one shell word.
  std::string line = "ssh -o BatchMode=yes {host} {command}";
  /// Between the end of a worker and its next start; doubles with each end in vain up to a minute.
  std::chrono::milliseconds pause{1000};
  unsigned ends_in_vain = 5;  ///< a host is given up after so many without a trial stored in between
};

/// The line with its places filled; an Error when one of them is missing.
Result<std::string> fill_line(const std::string& line, const std::string& host, const std::string& command);

class HostLauncher final : public Launcher {
 public:
  explicit HostLauncher(HostOptions options);
  void tick(const LaunchView& view, Time now) override;
  [[nodiscard]] const std::string& failure() const override { return failure_; }
  void stop(std::chrono::milliseconds patience) override;

 private:
  struct Slot {
    Host host;
    std::unique_ptr<ChildCommand> command = std::make_unique<ChildCommand>();
    Time next{};
    unsigned ends = 0;
    std::uint64_t stored = 0;
    bool given_up = false;
  };
  void start(Slot& slot);
  void on_end(Slot& slot, const CommandResult& result, const LaunchView& view, Time now);

  HostOptions options_;
  std::vector<Slot> slots_;
  std::string failure_;
};

}  // namespace fatmc
