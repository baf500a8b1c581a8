#include "campaigns/bias/trial.h"

#include <cmath>
#include <utility>

#include "campaigns/bias/row_arrays.h"
#include "campaigns/flown/flown_flights.h"

namespace fatmc::bias {
namespace {

class BiasTrials final : public PreparedCell {
 public:
  explicit BiasTrials(std::unique_ptr<const FlownFlights> flights) : flights_(std::move(flights)) {}

  TrialRow run(std::uint64_t repetition) const override {
    TrialRow row;
    row.key = flights_->key(repetition);
    const FlownFlights::Lease workspace = flights_->borrow();
    if (flights_->fly(repetition, *workspace, row)) {
      if (const FrmEstimate* frm = flights_->estimate(*workspace, row)) compare(*frm, row);
    }
    FlownFlights::describe(workspace->record, row);
    return row;
  }

  std::optional<TrialRecord> record(std::uint64_t repetition) const override {
    return flights_->record(repetition);
  }

 private:
  void compare(const FrmEstimate& frm, TrialRow& row) const {
    row.arrays.emplace_back(kFrequency, frm.frequency_hz);
    for (const Response& response : kResponses) {
      std::vector<double> re, im;
      for (int k = 0; k < frm.line_count(); ++k) {
        const std::complex<double> ratio =
            frm.G[k](response.output, response.input) /
            flights_->truth()[static_cast<std::size_t>(k)](response.output, response.input);
        re.push_back(ratio.real());
        im.push_back(ratio.imag());
      }
      row.arrays.emplace_back(ratio_re(response), std::move(re));
      row.arrays.emplace_back(ratio_im(response), std::move(im));
    }
    for (const Reading& reading : kReadings) {
      const MatrixStack<double> b = interpolation_bias(flights_->grid(), frm, reading.reading);
      for (const Response& response : kResponses) {
        const int k = nearest_line(frm, response.bias_hz);
        row.metrics.emplace_back(
            relative_bias(response, reading),
            b[k](response.output, response.input) / std::abs(frm.G[k](response.output, response.input)));
      }
    }
    row.metrics.emplace_back("degrees_of_freedom", frm.q);
  }

  static int nearest_line(const FrmEstimate& frm, double frequency_hz) {
    int best = 0;
    for (int k = 1; k < frm.line_count(); ++k) {
      const auto distance = [&](int at) {
        return std::abs(frm.frequency_hz[static_cast<std::size_t>(at)] - frequency_hz);
      };
      if (distance(k) < distance(best)) best = k;
    }
    return best;
  }

  std::unique_ptr<const FlownFlights> flights_;
};

Result<std::unique_ptr<PreparedCell>> prepare(const CampaignSpec& spec, std::uint32_t index) {
  auto cell = decode_flown_cell(spec, index);
  if (!cell) return fail(cell.error());
  auto flights = FlownFlights::prepare(spec, index, std::move(*cell));
  if (!flights) return fail(flights.error());
  return std::make_unique<BiasTrials>(std::move(*flights));
}

}  // namespace

const TrialStudy kTrialStudy{"bias", &prepare};

}  // namespace fatmc::bias
