#include "coordinator/state/suspects.h"

namespace fatmc {

void Suspects::blame(TrialKey trial, const WorkerDeath& death) {
  Suspicion& suspicion = trials_[trial];
  if (!suspicion.workers.empty() && death.leased < suspicion.counted) return;
  suspicion.workers.insert(death.worker);
  suspicion.counted = death.died;
  suspicion.last = death.how;
}

void Suspects::absolve(const std::string& worker) {
  for (auto trial = trials_.begin(); trial != trials_.end();) {
    trial->second.workers.erase(worker);
    trial = trial->second.workers.empty() ? trials_.erase(trial) : std::next(trial);
  }
}

std::size_t Suspects::deaths(TrialKey trial) const {
  const auto found = trials_.find(trial);
  return found == trials_.end() ? 0 : found->second.workers.size();
}

std::string Suspects::last_death(TrialKey trial) const {
  const auto found = trials_.find(trial);
  return found == trials_.end() ? std::string() : found->second.last;
}

std::uint64_t Suspects::next(std::uint32_t cell, std::uint64_t repetition) const {
  const auto found = trials_.lower_bound({cell, repetition});
  return found == trials_.end() || found->first.cell != cell ? UINT64_MAX : found->first.repetition;
}

}  // namespace fatmc
