#include "campaigns/variance/trial.h"

#include <utility>

#include "campaigns/flown/flown_flights.h"
#include "campaigns/variance/row_arrays.h"

namespace fatmc::variance {
namespace {

class VarianceTrials final : public PreparedCell {
 public:
  explicit VarianceTrials(std::unique_ptr<const FlownFlights> flights) : flights_(std::move(flights)) {}

  TrialRow run(std::uint64_t repetition) const override {
    TrialRow row;
    row.key = flights_->key(repetition);
    const FlownFlights::Lease workspace = flights_->borrow();
    if (flights_->fly(repetition, *workspace, row)) {
      if (const FrmEstimate* frm = flights_->estimate(*workspace, row)) keep(*frm, row);
    }
    FlownFlights::describe(workspace->record, row);
    return row;
  }

  std::optional<TrialRecord> record(std::uint64_t repetition) const override {
    return flights_->record(repetition);
  }

 private:
  static void keep(const FrmEstimate& frm, TrialRow& row) {
    std::vector<double> frequency, re, im, variance;
    for (const int k : shown_lines(frm.frequency_hz)) {
      frequency.push_back(frm.frequency_hz[static_cast<std::size_t>(k)]);
      for (int i = 0; i < frm.n_out; ++i) {
        for (int j = 0; j < frm.n_in; ++j) {
          re.push_back(frm.G[k](i, j).real());
          im.push_back(frm.G[k](i, j).imag());
          variance.push_back(frm.variance(k, i, j));
        }
      }
    }
    row.arrays.emplace_back(kFrequency, std::move(frequency));
    row.arrays.emplace_back(kReal, std::move(re));
    row.arrays.emplace_back(kImag, std::move(im));
    row.arrays.emplace_back(kVariance, std::move(variance));
    row.metrics.emplace_back("degrees_of_freedom", frm.q);
  }

  std::unique_ptr<const FlownFlights> flights_;
};

Result<std::unique_ptr<PreparedCell>> prepare(const CampaignSpec& spec, std::uint32_t index) {
  auto cell = decode_flown_cell(spec, index);
  if (!cell) return fail(cell.error());
  auto flights = FlownFlights::prepare(spec, index, std::move(*cell));
  if (!flights) return fail(flights.error());
  return std::make_unique<VarianceTrials>(std::move(*flights));
}

}  // namespace

const TrialStudy kTrialStudy{"variance", &prepare};

}  // namespace fatmc::variance
