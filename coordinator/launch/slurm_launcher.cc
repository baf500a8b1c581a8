#include "coordinator/launch/slurm_launcher.h"

#include <poll.h>
#include <pwd.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

#include "campaigns/base/trial_row.h"

namespace fatmc {
namespace {

constexpr std::uint64_t kLargestArray = 500;  // below Slurm's default MaxArraySize of 1001
constexpr unsigned kRejections = 3;

std::string user() {
  const passwd* entry = ::getpwuid(::geteuid());
  return entry != nullptr ? entry->pw_name : std::to_string(::geteuid());
}

std::vector<std::string> squeue(const std::string& name) {
  return {"squeue", "--noheader", "--array", "--user", user(), "--name", name, "--format", "%i %T"};
}

std::vector<std::string> scancel(const std::string& name) {
  return {"scancel", "--user", user(), "--name", name};
}

}  // namespace

std::string pilot_name(const std::string& campaign, const std::string& endpoint) {
  return "fatmc-" + hex(sha256(campaign + " " + endpoint)).substr(0, 16);
}

std::string pilot_script(const RemoteWorker& worker) {
  return "#!/bin/sh\nexport OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1\nexec " + command_line(worker) + "\n";
}

SlurmLauncher::SlurmLauncher(SlurmOptions options) : options_(std::move(options)) {}

// A line when something changes, not one a period.
void SlurmLauncher::say(const std::string& text, bool again) {
  if (text == said_ && !again) return;
  said_ = text;
  spdlog::info("{}", text);
  std::fprintf(stderr, "fatmc: %s\n", text.c_str());
}

void SlurmLauncher::begin(Step step, const std::vector<std::string>& arguments, const std::string& input,
                          Time now) {
  step_ = step;
  command_.start(arguments, input, now + options_.patience);
}

void SlurmLauncher::rest(Time now) {
  step_ = Step::idle;
  next_ = now + options_.period;
}

void SlurmLauncher::tick(const LaunchView& view, Time now) {
  if (step_ == Step::idle) {
    if (now >= next_ && failure_.empty()) begin(Step::query, squeue(options_.name), "", now);
    return;
  }
  const std::optional<CommandResult> result = command_.take(now);
  if (!result) return;
  switch (step_) {
    case Step::query:
      return on_queue(*result, view, now);
    case Step::submit:
      return on_submitted(*result, view, now);
    case Step::cancel:
    case Step::idle:
      return rest(now);
  }
}

void SlurmLauncher::on_queue(const CommandResult& result, const LaunchView& view, Time now) {
  rest(now);
  if (result.exit_code == 127) {
    failure_ = "Slurm's programs cannot be run (" + result.errors + ")";
    return;
  }
  if (!result.ok()) {
    answering_ = false;
    return say("Slurm does not answer (" + result.errors + "); pilots that run go on, others wait");
  }
  if (!answering_) say("Slurm answers again");
  answering_ = true;
  const std::vector<QueuedPilot> queue = parse_queue(result.output);
  if (!counted_ && !queue.empty())
    say("adopted " + std::to_string(queue.size()) + " pilots of an earlier coordinator");
  counted_ = true;
  known_ = queue.size();
  const PilotAction action = decide_pilots(queue, view, options_.pilots, options_.worker.jobs);
  if (action.submit > 0) return submit(action.submit, now);
  if (action.cancel.empty()) return;
  say("cancelling " + std::to_string(action.cancel.size()) + " pilots that are not needed any more");
  std::vector<std::string> arguments{"scancel"};
  arguments.insert(arguments.end(), action.cancel.begin(), action.cancel.end());
  begin(Step::cancel, arguments, "", now);
}

void SlurmLauncher::submit(std::uint64_t count, Time now) {
  if (trust_.lost(options_.pilots)) {
    failure_ = "pilots end without a trial done; their output is in " + options_.log_folder;
    return;
  }
  asked_ = std::min(count, kLargestArray);
  std::vector<std::string> arguments{"sbatch",
                                     "--parsable",
                                     "--job-name=" + options_.name,
                                     "--requeue",
                                     "--ntasks=1",
                                     "--cpus-per-task=" + std::to_string(options_.worker.jobs),
                                     "--output=" + options_.log_folder + "/%j.log",
                                     "--open-mode=append"};
  if (asked_ > 1) arguments.push_back("--array=1-" + std::to_string(asked_));
  arguments.insert(arguments.end(), options_.arguments.begin(), options_.arguments.end());
  begin(Step::submit, arguments, pilot_script(options_.worker), now);
}

void SlurmLauncher::on_submitted(const CommandResult& result, const LaunchView& view, Time now) {
  rest(now);
  if (result.ok()) {
    rejections_ = 0;
    trust_.submitted(asked_, view.stored);
    return say("submitted " + std::to_string(asked_) + " pilots, job " +
                   result.output.substr(0, result.output.find_first_of("\n;")),
               true);
  }
  // It may have been queued all the same: the queue, asked next, will tell.
  say("sbatch failed: " + result.errors);
  if (++rejections_ >= kRejections && answering_ && known_ == 0 && view.workers == 0)
    failure_ = "Slurm takes no pilots (" + result.errors + ")";
}

void SlurmLauncher::stop(std::chrono::milliseconds patience) {
  const Time end = std::chrono::steady_clock::now() + patience;
  while (command_.running() && !command_.take(std::chrono::steady_clock::now()) &&
         std::chrono::steady_clock::now() < end)
    ::poll(nullptr, 0, 5);
  do {
    const CommandResult cancelled = run_command(scancel(options_.name), "", options_.patience);
    if (!cancelled.ok()) continue;
    const CommandResult queue = run_command(squeue(options_.name), "", options_.patience);
    if (queue.ok() && parse_queue(queue.output).empty()) return;
  } while (std::chrono::steady_clock::now() < end && ::poll(nullptr, 0, 200) == 0);
  std::string line;
  for (const std::string& word : scancel(options_.name)) line += (line.empty() ? "" : " ") + shell_word(word);
  say("Slurm may still hold pilots of this run; they end by themselves " +
      std::to_string(options_.worker.leave_after.count()) + " s after the coordinator, or by: " + line);
}

}  // namespace fatmc
