// Trials that may be killing their workers.
//
// When a worker dies, any trial that it had not delivered may be the one that killed it. Each of them is
// suspected, and leased alone from then on, until it is finished (cleared) or three workers died over it.
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>

#include "campaigns/base/trial_row.h"

namespace fatmc {

class Suspects {
 public:
  /// `worker` died while it held this trial; `how` it died. A worker counts once a trial.
  void blame(TrialKey trial, const std::string& worker, const std::string& how);
  /// The worker, whose silence was taken for death, lives.
  void absolve(const std::string& worker);
  /// The trial is finished.
  void clear(TrialKey trial) { trials_.erase(trial); }

  /// Workers that died over it.
  [[nodiscard]] std::size_t deaths(TrialKey trial) const;
  /// How the last of them died.
  [[nodiscard]] std::string last_death(TrialKey trial) const;
  /// The first suspect of the cell at or after `repetition`, or the largest number.
  [[nodiscard]] std::uint64_t next(std::uint32_t cell, std::uint64_t repetition) const;
  [[nodiscard]] std::size_t size() const { return trials_.size(); }

 private:
  struct Suspicion {
    std::set<std::string> workers;
    std::string last;
  };
  std::map<TrialKey, Suspicion> trials_;
};

}  // namespace fatmc
