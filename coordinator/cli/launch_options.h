// Where `fatmc run` gets its workers from.
#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <string>
#include <vector>

#include "campaigns/base/campaign_spec.h"
#include "coordinator/launch/launcher.h"
#include "core/base/error.h"

namespace fatmc::cli {

struct LaunchOptions {
  std::string launcher = "local";
  std::string hosts, line, bind, advertise, keys, program;
  unsigned jobs = 1;
  double leave_after_s = 300.0;
  std::vector<std::string> sbatch;

  [[nodiscard]] bool is_local() const { return launcher == "local"; }
};

void add_launch_options(CLI::App& command, LaunchOptions& options);

/// The same as words of a command line.
std::vector<std::string> words_of(const LaunchOptions& options);

/// Whether the options fit together, so that nothing is written when they do not.
Status check(const LaunchOptions& options);

/// Where to listen: --bind, or a port that belongs to the campaign, so that a coordinator that is started
/// again is found by the workers of the one before.
std::string bind_endpoint(const LaunchOptions& options, const CampaignSpec& spec);

/// The folder of keys, made where there is none: --keys, or DB.keys.
Result<std::string> key_folder(const LaunchOptions& options, const std::string& database);

/// `bound`: the endpoint that was had; `most`: worker processes.
Result<std::unique_ptr<Launcher>> make_launcher(const LaunchOptions& options, const CampaignSpec& spec,
                                                const std::string& database, const std::string& keys,
                                                const std::string& bound, std::uint64_t most);

}  // namespace fatmc::cli
