// How many pilots there should be, decided without Slurm, clock or process.
//
// A pilot is a batch job that runs one fatmc-worker until the campaign is done: one job for many trials,
// never one a trial. What the queue says is one witness, what is connected another: after a controller lost
// its memory a pilot may compute that no queue knows (a ghost), and after an sbatch that timed out a job may
// be there that nobody was told of. Both count, so that no pilot is started twice; should one run twice all
// the same, each process has an incarnation of its own, and results are stored once.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "coordinator/launch/launcher.h"

namespace fatmc {

/// A line of the queue.
struct QueuedPilot {
  std::string id;  ///< "123" or "123_4"
  bool pending = false;
  bool operator==(const QueuedPilot&) const = default;
};

/// Reads what `squeue --noheader --array --format "%i %T"` prints; jobs that are ending are left out.
std::vector<QueuedPilot> parse_queue(std::string_view text);

struct PilotAction {
  std::uint64_t submit = 0;
  std::vector<std::string> cancel;  ///< jobs that are not needed any more, pending ones only
  bool operator==(const PilotAction&) const = default;
};

/// `most`: pilots that the user asked for; `jobs`: trials at a time of each.
PilotAction decide_pilots(const std::vector<QueuedPilot>& queue, const LaunchView& view, std::uint64_t most,
                          unsigned jobs);

/// Whether starting pilots leads anywhere.
class PilotTrust {
 public:
  /// Pilots were submitted; `stored` as in LaunchView.
  void submitted(std::uint64_t count, std::uint64_t stored);
  /// Submissions since the last trial was stored, beyond which the launcher gives up.
  [[nodiscard]] bool lost(std::uint64_t most) const { return in_vain_ > 3 * most + 2; }

 private:
  std::uint64_t in_vain_ = 0, stored_ = 0;
};

}  // namespace fatmc
