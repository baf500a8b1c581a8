// Trials that may be killing their workers.
//
// When a worker dies, any trial that it had not delivered may be the one that killed it. Each of them is
// suspected, and leased alone from then on, until it is finished (cleared) or three workers died over it, one
// after another: those who had copies of it at the same time may have died of one cause that is not the trial,
// such as a cable or an administrator, and count as one.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <set>
#include <string>

#include "campaigns/base/trial_row.h"

namespace fatmc {

/// Of a worker that held a trial.
struct WorkerDeath {
  std::string worker;
  std::string how;
  std::chrono::nanoseconds leased{};  ///< when it got the trial, since any fixed moment
  std::chrono::nanoseconds died{};    ///< when it was known to be dead
};

class Suspects {
 public:
  /// Counts a worker once a trial, and not when it got the trial before the last death that counted.
  void blame(TrialKey trial, const WorkerDeath& death);
  /// The worker, whose silence was taken for death, lives.
  void absolve(const std::string& worker);
  /// The trial is finished.
  void clear(TrialKey trial) { trials_.erase(trial); }

  /// Workers that died over it, one after another.
  [[nodiscard]] std::size_t deaths(TrialKey trial) const;
  /// How the last of them died.
  [[nodiscard]] std::string last_death(TrialKey trial) const;
  /// The first suspect of the cell at or after `repetition`, or the largest number.
  [[nodiscard]] std::uint64_t next(std::uint32_t cell, std::uint64_t repetition) const;
  [[nodiscard]] std::size_t size() const { return trials_.size(); }

 private:
  struct Suspicion {
    std::set<std::string> workers;
    std::chrono::nanoseconds counted{};  ///< the last death
    std::string last;
  };
  std::map<TrialKey, Suspicion> trials_;
};

}  // namespace fatmc
