#include "campaigns/flown/flown_trials.h"

namespace fatmc {

TrialRow FlownTrials::run(std::uint64_t repetition) const {
  TrialRow row;
  row.key = flights_->key(repetition);
  const FlownFlights::Lease workspace = flights_->borrow();
  if (flights_->fly(repetition, *workspace, row)) {
    if (const FrmEstimate* frm = flights_->estimate(*workspace, row)) keep(*frm, workspace->record, row);
  }
  FlownFlights::describe(workspace->record, row);
  return row;
}

std::optional<TrialRecord> FlownTrials::record(std::uint64_t repetition) const {
  return flights_->record(repetition);
}

}  // namespace fatmc
