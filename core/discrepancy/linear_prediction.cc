#include "core/discrepancy/linear_prediction.h"

#include <Eigen/QR>
#include <cmath>
#include <numbers>

#include "core/base/text.h"

namespace fatmc {
namespace {

/// The model with its states as further inputs: one factorisation of z I - A serves G and C (z I - A)^-1.
SampledModel with_state_inputs(const SampledModel& model) {
  const Eigen::Index n = model.a.rows(), inputs = model.b.cols();
  SampledModel out{model.a, Eigen::MatrixXd(n, inputs + n), model.c,
                   Eigen::MatrixXd::Zero(model.c.rows(), inputs + n)};
  out.b << model.b, Eigen::MatrixXd::Identity(n, n);
  out.d.leftCols(inputs) = model.d;
  return out;
}

/// Real parts above imaginary parts.
Eigen::MatrixXd parts(const Eigen::MatrixXcd& values) {
  Eigen::MatrixXd out(2 * values.rows(), values.cols());
  out << values.real(), values.imag();
  return out;
}

/// d of least squares over all outputs, each divided by `scale`. `paths`: an output each, bins x states.
Eigen::VectorXd fitted_start(const std::vector<Eigen::MatrixXcd>& paths, const Eigen::MatrixXcd& error,
                             const Eigen::VectorXd& scale) {
  const Eigen::Index rows = 2 * error.rows(), states = paths.front().cols();
  Eigen::MatrixXd columns(rows * error.cols(), states);
  Eigen::VectorXd values(rows * error.cols());
  for (Eigen::Index i = 0; i < error.cols(); ++i) {
    columns.middleRows(i * rows, rows) = parts(paths[static_cast<std::size_t>(i)]) / scale[i];
    values.segment(i * rows, rows) = parts(error.col(i)) / scale[i];
  }
  // Modes that die out within a sample and such that last for the whole record differ by orders of magnitude.
  Eigen::VectorXd norms = columns.colwise().norm().transpose();
  norms = (norms.array() > 0.0).select(norms, 1.0);
  columns = columns * norms.cwiseInverse().asDiagonal();
  return Eigen::ColPivHouseholderQR<Eigen::MatrixXd>(columns).solve(values).cwiseQuotient(norms);
}

Eigen::MatrixXcd without_start(const std::vector<Eigen::MatrixXcd>& paths, Eigen::MatrixXcd error,
                               const Eigen::VectorXd& start) {
  for (Eigen::Index i = 0; i < error.cols(); ++i)
    error.col(i) -= paths[static_cast<std::size_t>(i)] * start.cast<std::complex<double>>();
  return error;
}

/// Norms of the columns, 1 where one is zero.
Eigen::VectorXd norms_of(const Eigen::MatrixXcd& values) {
  const Eigen::VectorXd norms = values.colwise().norm().transpose();
  return (norms.array() > 0.0).select(norms, 1.0);
}

}  // namespace

Result<LinearPrediction> predict_linear(const SampledModel& model, double rate_hz, int samples,
                                        const std::vector<double>& frequency_hz,
                                        const Eigen::Ref<const Eigen::MatrixXcd>& input,
                                        const Eigen::Ref<const Eigen::MatrixXcd>& output) {
  const Eigen::Index bins = input.rows(), inputs = input.cols(), outputs = output.cols(),
                     states = model.a.rows();
  if (2 * bins * outputs <= states)
    return fail("has " + std::to_string(bins) + " bins in the band for a model of " + std::to_string(states) +
                " states: take a wider band or a longer record");
  const SampledModel extended = with_state_inputs(model);
  // A response is the larger the nearer a pole: beyond this one lies within 1e-10 of the bin's z.
  const double most = 1e10 * (extended.c.norm() * extended.b.norm() + extended.d.norm());
  LinearPrediction out;
  out.response.resize(static_cast<int>(outputs), static_cast<int>(inputs), static_cast<int>(bins));
  out.error = output;
  std::vector<Eigen::MatrixXcd> paths(static_cast<std::size_t>(outputs), Eigen::MatrixXcd(bins, states));
  for (Eigen::Index m = 0; m < bins; ++m) {
    const double f = frequency_hz[static_cast<std::size_t>(m)];
    const Eigen::MatrixXcd all = sampled_response(extended, f, rate_hz);
    if (!(all.norm() < most))
      return fail("the model has a pole on the unit circle at " + significant(f, 6) +
                  " Hz, a bin of the record");
    out.response[static_cast<int>(m)] = all.leftCols(inputs);
    out.error.row(m) -= (all.leftCols(inputs) * input.row(m).transpose()).transpose();
    const std::complex<double> factor =
        std::polar(1.0 / std::sqrt(static_cast<double>(samples)), 2.0 * std::numbers::pi * f / rate_hz);
    for (Eigen::Index i = 0; i < outputs; ++i)
      paths[static_cast<std::size_t>(i)].row(m) = factor * all.row(i).tail(states);
  }
  if (states == 0) return out;
  const Eigen::MatrixXcd whole = out.error;
  out.start = fitted_start(paths, whole, norms_of(output));
  out.start = fitted_start(paths, whole, norms_of(without_start(paths, whole, out.start)));
  out.error = without_start(paths, whole, out.start);
  return out;
}

}  // namespace fatmc
