// One coordinator's life with one database, as `fatmc run` and `fatmc coordinator` share it.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "campaigns/base/campaign_spec.h"
#include "coordinator/cli/campaign_input.h"
#include "coordinator/cli/command.h"
#include "coordinator/launch/launcher.h"

namespace fatmc::cli {

struct SessionOptions {
  std::string database;
  /// Databases that belong to the same run, before this one.
  std::vector<std::string> earlier;
  std::string endpoint = "tcp://127.0.0.1:*";
  /// Folder of keys; empty: keys of its own when it starts its workers, else a plain socket on the loopback.
  std::string keys;
  /// Worker processes to start here; 0: workers come by themselves.
  unsigned workers = 0;
  /// Makes what starts workers elsewhere, once the endpoint is had; empty: nobody does.
  std::function<Result<std::unique_ptr<Launcher>>(const std::string& endpoint)> launcher;
  Shard shard;
  bool verbose = false;
  /// Trials that were given up are tried again.
  bool retry_quarantined = false;
  /// The command that resumes this one.
  std::string resume_command;
};

/// Serves the campaign until it is done, then prints outcomes and tables.
Exit run_session(const CampaignSpec& spec, const SessionOptions& options);

/// "results/NAME.db", or "results/NAME.2of4.db"
std::string default_database(const CampaignSpec& spec, const Shard& shard = {});

/// The words as a line that a shell reads back.
std::string shell_line(const std::vector<std::string>& words);

}  // namespace fatmc::cli
