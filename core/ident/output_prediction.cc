#include "core/ident/output_prediction.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <string>

#include "core/base/check.h"
#include "core/base/text.h"
#include "core/ident/mean_spectra.h"
#include "core/signal/dft.h"

namespace fatmc {
namespace {

/// G at f, linear between the neighbouring lines.
Eigen::MatrixXcd interpolated(const std::vector<double>& lines,
                              const MatrixStack<std::complex<double>>& response, double f) {
  const auto above = std::lower_bound(lines.begin(), lines.end(), f);
  const auto at = static_cast<int>(above - lines.begin());
  if (at == 0) return response[0];
  if (above == lines.end()) return response[at - 1];
  const double low = lines[static_cast<std::size_t>(at - 1)], weight = (f - low) / (*above - low);
  return (1.0 - weight) * response[at - 1] + weight * response[at];
}

Eigen::MatrixXd signals(const Eigen::MatrixXcd& bins, Eigen::Index samples) {
  Eigen::MatrixXd out(samples, bins.cols());
  for (Eigen::Index c = 0; c < bins.cols(); ++c) {
    inverse_real_dft(std::span(bins.col(c).data(), static_cast<std::size_t>(bins.rows())),
                     std::span(out.col(c).data(), static_cast<std::size_t>(samples)));
  }
  return out;
}

}  // namespace

Result<OutputPrediction> predict_outputs(const std::vector<double>& frequency_hz,
                                         const MatrixStack<std::complex<double>>& response,
                                         const Eigen::Ref<const Eigen::MatrixXd>& outputs,
                                         const Eigen::Ref<const Eigen::MatrixXd>& inputs, double rate_hz) {
  FATMC_CHECK(!frequency_hz.empty() && response.rows() == outputs.cols() && response.cols() == inputs.cols(),
              "a response of these channels");
  const auto n = static_cast<double>(outputs.rows());
  OutputPrediction out;
  constexpr double kRounding = 1e-6;  // of a bin: lines come from decimal text
  out.first_bin = std::max(1, static_cast<int>(std::ceil(frequency_hz.front() * n / rate_hz - kRounding)));
  out.last_bin = std::min(static_cast<int>(outputs.rows() - 1) / 2,
                          static_cast<int>(std::floor(frequency_hz.back() * n / rate_hz + kRounding)));
  if (out.last_bin < out.first_bin) {
    return fail("no frequency of the record (up to " + significant(rate_hz / 2.0, 4) + " Hz, " +
                significant(rate_hz / n, 3) + " Hz apart) lies between the response's lines, " +
                significant(frequency_hz.front(), 4) + " to " + significant(frequency_hz.back(), 4) + " Hz");
  }
  Eigen::MatrixXcd y = record_spectrum(outputs, out.last_bin + 1);
  const Eigen::MatrixXcd u = record_spectrum(inputs, out.last_bin + 1);
  y.topRows(out.first_bin).setZero();
  Eigen::MatrixXcd predicted = Eigen::MatrixXcd::Zero(y.rows(), y.cols());
  for (int k = out.first_bin; k <= out.last_bin; ++k) {
    predicted.row(k) =
        (interpolated(frequency_hz, response, k * rate_hz / n) * u.row(k).transpose()).transpose();
  }
  const Eigen::VectorXd energy = y.colwise().squaredNorm().transpose();
  for (Eigen::Index i = 0; i < energy.size(); ++i) {
    if (!(energy(i) > 0.0))
      return fail("output " + std::to_string(i + 1) + " is nothing between the response's lines");
  }
  out.vaf = 1.0 - (y - predicted).colwise().squaredNorm().transpose().array() / energy.array();
  const Eigen::VectorXd variance = (outputs.rowwise() - outputs.colwise().mean())
                                       .colwise()
                                       .squaredNorm()
                                       .transpose();  // every bin twice but 0 and N/2
  out.band_share = (2.0 * energy.array() / variance.array()).min(1.0);
  out.measured = signals(y, outputs.rows());
  out.predicted = signals(predicted, outputs.rows());
  return out;
}

}  // namespace fatmc
