#include "campaigns/variance/trial.h"

#include <utility>

#include "campaigns/flown/flown_trials.h"
#include "campaigns/variance/row_arrays.h"

namespace fatmc::variance {
namespace {

class VarianceTrials final : public FlownTrials {
 public:
  explicit VarianceTrials(std::unique_ptr<const FlownFlights> flown) : FlownTrials(std::move(flown)) {}

 private:
  void keep(const FrmEstimate& frm, const FlightRecord&, TrialRow& row) const override {
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
};

}  // namespace

const TrialStudy kTrialStudy{"variance", &prepare_flown<VarianceTrials>};

}  // namespace fatmc::variance
