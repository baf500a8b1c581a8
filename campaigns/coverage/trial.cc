#include "campaigns/coverage/trial.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "campaigns/coverage/row_arrays.h"
#include "campaigns/flown/flown_trials.h"
#include "core/ident/interpolation_bias.h"
#include "core/stats/confidence.h"

namespace fatmc::coverage {
namespace {

constexpr int kAxes = 3;
constexpr const char* kInputSuffix[] = {"xi_c", "eta_c", "zeta_c"};

class CoverageTrials final : public FlownTrials {
 public:
  explicit CoverageTrials(std::unique_ptr<const FlownFlights> flown) : FlownTrials(std::move(flown)) {}

 private:
  void keep(const FrmEstimate& frm, const FlightRecord& record, TrialRow& row) const override {
    const MatrixStack<double> bias = interpolation_bias(flights().grid(), frm, BiasConstant::exact_offsets);
    std::optional<MatrixStack<double>> printed;  // print has constants for the orders 2, 4 and 6
    if (printed_bias_constant(flights().cell().estimator.order)) {
      printed = interpolation_bias(flights().grid(), frm, BiasConstant::printed);
    }
    store(frm, bias, printed, row);
    row.metrics.emplace_back("mean_speed_m_s", record.auxiliary.col(2).mean());
  }

  void store(const FrmEstimate& frm, const MatrixStack<double>& bias,
             const std::optional<MatrixStack<double>>& printed, TrialRow& row) const {
    std::vector<double> re, im, variance, b, b_printed, snr;
    const double quantile = f_quantile_2_2q(0.95, frm.q);
    std::size_t inside = 0, inside_extended = 0;
    for (int k = 0; k < frm.line_count(); ++k) {
      for (int i = 0; i < kAxes; ++i) {
        for (int j = 0; j < kAxes; ++j) {
          const std::complex<double> error =
              frm.G[k](i, j) - flights().truth()[static_cast<std::size_t>(k)](i, j);
          re.push_back(error.real());
          im.push_back(error.imag());
          variance.push_back(frm.variance(k, i, j));
          b.push_back(bias[k](i, j));
          const double limit = quantile * frm.variance(k, i, j);
          const double beyond = std::max(0.0, std::abs(error) - bias[k](i, j));
          inside += std::norm(error) <= limit ? 1 : 0;
          inside_extended += beyond * beyond <= limit ? 1 : 0;
          if (printed) b_printed.push_back((*printed)[k](i, j));
        }
      }
      for (int j = 0; j < kAxes; ++j)
        snr.push_back(20.0 * std::log10(std::max(frm.input_snr[k](j, 0), 1e-15)));
    }
    row.metrics.emplace_back(kDegreesOfFreedom, frm.q);
    row.metrics.emplace_back(kElements, kAxes * kAxes);
    row.metrics.emplace_back(kInputs, kAxes);
    row.metrics.emplace_back(kInside95, static_cast<double>(inside) / static_cast<double>(re.size()));
    row.metrics.emplace_back(kInsideExtended95,
                             static_cast<double>(inside_extended) / static_cast<double>(re.size()));
    for (int j = 0; j < kAxes; ++j) {
      double low = std::numeric_limits<double>::infinity();
      for (std::size_t k = 0; k < snr.size(); k += kAxes)
        low = std::min(low, snr[k + static_cast<std::size_t>(j)]);
      row.metrics.emplace_back(std::string("smallest_input_snr_db_") + kInputSuffix[j], low);
    }
    row.arrays.emplace_back(kErrorReal, std::move(re));
    row.arrays.emplace_back(kErrorImag, std::move(im));
    row.arrays.emplace_back(kVariance, std::move(variance));
    row.arrays.emplace_back(kBias, std::move(b));
    if (printed) row.arrays.emplace_back(kBiasPrinted, std::move(b_printed));
    row.arrays.emplace_back(kInputSnr, std::move(snr));
  }
};

}  // namespace

const TrialStudy kTrialStudy{"coverage", &prepare_flown<CoverageTrials>};

}  // namespace fatmc::coverage
