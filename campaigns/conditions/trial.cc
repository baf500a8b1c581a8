#include "campaigns/conditions/trial.h"

#include <algorithm>
#include <cmath>

#include "campaigns/conditions/row_arrays.h"
#include "campaigns/flown/flown_trials.h"
#include "core/stats/confidence.h"
#include "core/stats/empirical.h"

namespace fatmc::conditions {
namespace {

constexpr int kAxes = 3;

class ConditionTrials final : public FlownTrials {
 public:
  explicit ConditionTrials(std::unique_ptr<const FlownFlights> flown) : FlownTrials(std::move(flown)) {
    for (int k = 0; k < flights().grid().line_count(); ++k)
      frequency_hz_.push_back(flights().grid().frequency_hz(k));
  }

 private:
  [[nodiscard]] std::complex<double> truth(int k, int i, int j) const {
    return flights().truth()[static_cast<std::size_t>(k)](i, j);
  }

  void keep(const FrmEstimate& frm, const FlightRecord&, TrialRow& row) const override {
    row.arrays.emplace_back(kFrequency, frequency_hz_);
    for (const Element& element : kElements) store_element(element, frm, row);
    const double quantile = f_quantile_2_2q(0.95, frm.q);
    std::size_t inside = 0;
    std::array<std::vector<double>, kAxes> snr;
    std::size_t outliers = 0;
    for (int k = 0; k < frm.line_count(); ++k) {
      for (int i = 0; i < kAxes; ++i) {
        for (int j = 0; j < kAxes; ++j) {
          inside += std::norm(frm.G[k](i, j) - truth(k, i, j)) <= quantile * frm.variance(k, i, j) ? 1 : 0;
        }
        // (|U| - s)/s is negative for an outlier; the median is not among those unless most lines are.
        snr[static_cast<std::size_t>(i)].push_back(20.0 *
                                                   std::log10(std::max(frm.input_snr[k](i, 0), 1e-15)));
        outliers += frm.outlier[k](i, 0) != 0 ? 1 : 0;
      }
    }
    row.metrics.emplace_back(kInside95, static_cast<double>(inside) / (kAxes * kAxes * frm.line_count()));
    row.metrics.emplace_back(kOutliers, static_cast<double>(outliers) / (kAxes * frm.line_count()));
    for (std::size_t j = 0; j < snr.size(); ++j)
      row.metrics.emplace_back(kMedianSnr[j], EmpiricalCdf(std::move(snr[j])).quantile(0.5));
  }

  void store_element(const Element& element, const FrmEstimate& frm, TrialRow& row) const {
    std::vector<double> re, im, variance;
    double square = 0.0;
    for (int k = 0; k < frm.line_count(); ++k) {
      const std::complex<double> g0 = truth(k, element.output, element.input);
      const std::complex<double> error = frm.G[k](element.output, element.input) / g0 - 1.0;
      re.push_back(error.real());
      im.push_back(error.imag());
      variance.push_back(frm.variance(k, element.output, element.input) / std::norm(g0));
      square += std::norm(error);
    }
    row.metrics.emplace_back(name_of(element, kRelativeError), std::sqrt(square / frm.line_count()));
    row.arrays.emplace_back(name_of(element, kErrorReal), std::move(re));
    row.arrays.emplace_back(name_of(element, kErrorImag), std::move(im));
    row.arrays.emplace_back(name_of(element, kVariance), std::move(variance));
  }

  std::vector<double> frequency_hz_;
};

}  // namespace

const TrialStudy kTrialStudy{"conditions", &prepare_flown<ConditionTrials>};

}  // namespace fatmc::conditions
