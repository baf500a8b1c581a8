// A cell whose trial is one flight and its fast-LPM estimate: the study says what it keeps of the estimate.
#pragma once

#include <memory>
#include <utility>

#include "campaigns/base/study.h"
#include "campaigns/flown/flown_flights.h"

namespace fatmc {

class FlownTrials : public PreparedCell {
 public:
  [[nodiscard]] TrialRow run(std::uint64_t repetition) const final;
  [[nodiscard]] std::optional<TrialRecord> record(std::uint64_t repetition) const final;

 protected:
  explicit FlownTrials(std::unique_ptr<const FlownFlights> flights) : flights_(std::move(flights)) {}
  [[nodiscard]] const FlownFlights& flights() const { return *flights_; }

 private:
  /// Metrics and arrays of a flight and its estimate; not called for a flight that ended early or a line without one.
  virtual void keep(const FrmEstimate& frm, const FlightRecord& record, TrialRow& row) const = 0;

  std::unique_ptr<const FlownFlights> flights_;
};

/// `prepare` of a study that needs nothing but the flights.
template <class Trials>
Result<std::unique_ptr<PreparedCell>> prepare_flown(const CampaignSpec& spec, std::uint32_t index) {
  auto cell = decode_flown_cell(spec, index);
  if (!cell) return fail(cell.error());
  auto flights = FlownFlights::prepare(spec, index, std::move(*cell));
  if (!flights) return fail(flights.error());
  return std::make_unique<Trials>(std::move(*flights));
}

}  // namespace fatmc
