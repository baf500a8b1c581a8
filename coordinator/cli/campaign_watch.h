// What goes on beside the rows of a running campaign: the precision that ends cells, wishes from other
// terminals (pause, extend), word of trials that take long, and what the progress line says.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "coordinator/cli/progress_line.h"
#include "coordinator/server/campaign_server.h"
#include "coordinator/state/campaign_state.h"
#include "coordinator/state/precision_monitor.h"
#include "coordinator/store/campaign_store.h"

namespace fatmc::cli {

/// Single-threaded, called by the server's hooks. All it is given must outlive it.
class CampaignWatch {
 public:
  /// Reads what `database` holds already; cells that are precise enough by it are ended at once. A shard lacks
  /// the trials before its own: neither [stop] nor more trials can be judged there.
  CampaignWatch(const CampaignSpec& spec, const std::string& database, bool is_shard, CampaignState& state,
                CampaignStore& store);

  void on_committed(const StoreRequest& request, const StoreReport& report, CampaignServer& server);
  void on_tick(CampaignServer& server);
  /// The run is over; trials that are still out are forgotten unless that is what it failed of.
  void on_end(bool failed);
  [[nodiscard]] Progress progress() const;

 private:
  void read_stored(const std::string& database);
  /// Ends cells whose precision is reached; where the disk refuses, the next call tries again.
  void end_precise_cells(const std::function<void(std::uint32_t, std::uint64_t)>& set_repetitions);
  void obey(CampaignServer& server);
  void report_leases();
  [[nodiscard]] std::string precision_text() const;

  const CampaignSpec& spec_;
  bool is_shard_;
  CampaignState& state_;
  ControlTables control_;
  ControlState wanted_;
  std::optional<PrecisionMonitor> monitor_;
  std::string said_failure_;
  std::map<std::string, std::uint64_t> outcomes_;
  MonotonicTime last_report_{};
  bool leases_reported_ = false;
};

}  // namespace fatmc::cli
