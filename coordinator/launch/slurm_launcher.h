// Pilots through Slurm: sbatch starts them, squeue counts them, scancel ends them.
//
// Nothing is kept in files: a coordinator that is started again finds the pilots of the one before by their
// name, which is made of campaign and endpoint, and adopts them. While the controller (slurmctld) does not
// answer, nothing is decided; pilots that run go on computing.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "coordinator/launch/child_command.h"
#include "coordinator/launch/launcher.h"
#include "coordinator/launch/pilot_plan.h"

namespace fatmc {

struct SlurmOptions {
  RemoteWorker worker;
  std::uint64_t pilots = 1;            ///< at most
  std::string name;                    ///< of the jobs, see pilot_name()
  std::string log_folder;              ///< output of pilots, a file a job
  std::vector<std::string> arguments;  ///< more for sbatch: partition, time limit ...
  std::chrono::milliseconds period{2000};
  /// After which a command is taken to hang: Slurm's own tools try for minutes.
  std::chrono::milliseconds patience{10'000};
};

/// The same for coordinators that pilots of one another can serve.
std::string pilot_name(const std::string& campaign, const std::string& endpoint);

/// The batch script of a pilot.
std::string pilot_script(const RemoteWorker& worker);

class SlurmLauncher final : public Launcher {
 public:
  explicit SlurmLauncher(SlurmOptions options);
  void tick(const LaunchView& view, Time now) override;
  [[nodiscard]] const std::string& failure() const override { return failure_; }
  void stop(std::chrono::milliseconds patience) override;

 private:
  enum class Step { idle, query, submit, cancel };
  void begin(Step step, const std::vector<std::string>& arguments, const std::string& input, Time now);
  void on_queue(const CommandResult& result, const LaunchView& view, Time now);
  void on_submitted(const CommandResult& result, const LaunchView& view, Time now);
  void submit(std::uint64_t count, Time now);
  void rest(Time now);
  void say(const std::string& text, bool again = false);

  SlurmOptions options_;
  ChildCommand command_;
  Step step_ = Step::idle;
  Time next_{};
  bool counted_ = false;     ///< the queue was read at least once
  bool answering_ = true;    ///< the last question was answered
  std::size_t known_ = 0;    ///< pilots in the queue when it was last read
  std::uint64_t asked_ = 0;  ///< pilots of the submission that runs
  unsigned rejections_ = 0;  ///< submissions in a row that a controller that answers turned away
  PilotTrust trust_;
  std::string failure_, said_;
};

}  // namespace fatmc
