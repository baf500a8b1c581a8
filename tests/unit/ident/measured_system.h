// Records of made-up systems in the time domain, from rest or in steady state.
#pragma once

#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "core/ident/measurement.h"
#include "core/random/random_stream.h"
#include "core/signal/multisine.h"

namespace fatmc::test {

/// y[n] = b1 u[n-1] + b2 u[n-2] - a1 y[n-1] - a2 y[n-2]: a mode at `frequency` (cycles a sample) with `damping`.
struct Mode {
  double a1, a2, b1 = 0.02, b2 = 0.018;

  Mode(double frequency, double damping) {
    const double w = 2.0 * std::numbers::pi * frequency;
    a1 = -2.0 * std::exp(-damping * w) * std::cos(w * std::sqrt(1.0 - damping * damping));
    a2 = std::exp(-2.0 * damping * w);
  }

  [[nodiscard]] std::complex<double> response(double frequency) const {
    const std::complex<double> q = std::polar(1.0, -2.0 * std::numbers::pi * frequency);
    return (b1 * q + b2 * q * q) / (1.0 + a1 * q + a2 * q * q);
  }
  /// From rest.
  [[nodiscard]] Eigen::VectorXd simulate(const Eigen::VectorXd& u) const {
    Eigen::VectorXd y = Eigen::VectorXd::Zero(u.size());
    for (Eigen::Index n = 1; n < u.size(); ++n) {
      y(n) = b1 * u(n - 1) - a1 * y(n - 1);
      if (n > 1) y(n) += b2 * u(n - 2) - a2 * y(n - 2);
    }
    return y;
  }
};

inline Eigen::MatrixXd white(int rows, int cols, double deviation, RandomStream& stream) {
  Eigen::MatrixXd x(rows, cols);
  for (auto& value : x.reshaped()) value = deviation * stream.normal();
  return x;
}

inline Eigen::VectorXd column(const std::vector<double>& x) {
  return Eigen::Map<const Eigen::VectorXd>(x.data(), static_cast<Eigen::Index>(x.size()));
}

/// Multisine on `lines`, one column.
inline Eigen::VectorXd multisine(int period, int periods, const std::vector<int>& lines, RandomStream& stream) {
  return column(Multisine::random_phase(period, lines, 1.0, stream).samples(periods));
}

}  // namespace fatmc::test
