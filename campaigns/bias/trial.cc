#include "campaigns/bias/trial.h"

#include <cmath>
#include <utility>

#include "campaigns/base/line_runs.h"
#include "campaigns/bias/row_arrays.h"
#include "campaigns/flown/flown_trials.h"

namespace fatmc::bias {
namespace {

class BiasTrials final : public FlownTrials {
 public:
  explicit BiasTrials(std::unique_ptr<const FlownFlights> flown) : FlownTrials(std::move(flown)) {}

 private:
  void keep(const FrmEstimate& frm, const FlightRecord&, TrialRow& row) const override {
    row.arrays.emplace_back(kFrequency, frm.frequency_hz);
    for (const Response& response : kResponses) {
      std::vector<double> re, im;
      for (int k = 0; k < frm.line_count(); ++k) {
        const std::complex<double> ratio =
            frm.G[k](response.output, response.input) /
            flights().truth()[static_cast<std::size_t>(k)](response.output, response.input);
        re.push_back(ratio.real());
        im.push_back(ratio.imag());
      }
      row.arrays.emplace_back(ratio_re(response), std::move(re));
      row.arrays.emplace_back(ratio_im(response), std::move(im));
    }
    for (const Reading& reading : kReadings) {
      const MatrixStack<double> b = interpolation_bias(flights().grid(), frm, reading.reading);
      for (const Response& response : kResponses) {
        const int k = static_cast<int>(nearest_line(frm.frequency_hz, response.bias_hz));
        row.metrics.emplace_back(
            relative_bias(response, reading),
            b[k](response.output, response.input) / std::abs(frm.G[k](response.output, response.input)));
      }
    }
    row.metrics.emplace_back("degrees_of_freedom", frm.q);
  }
};

}  // namespace

const TrialStudy kTrialStudy{"bias", &prepare_flown<BiasTrials>};

}  // namespace fatmc::bias
