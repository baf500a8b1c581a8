#include "core/signal/decimate.h"

#include <cmath>
#include <numbers>

#include "core/base/check.h"

namespace fatmc {
namespace {

constexpr int kHalfLengthPerFactor = 10;
constexpr double kCut = 0.8;  // of the new Nyquist frequency

/// Taps -half ... half.
Eigen::VectorXd low_pass(int half, int factor) {
  Eigen::VectorXd taps(2 * half + 1);
  for (int i = -half; i <= half; ++i) {
    const double x = kCut * std::numbers::pi * i / factor;
    const double window = 0.54 + 0.46 * std::cos(std::numbers::pi * i / half);
    taps(i + half) = window * (i == 0 ? 1.0 : std::sin(x) / x);
  }
  return taps / taps.sum();
}

}  // namespace

Eigen::MatrixXd decimate(const Eigen::Ref<const Eigen::MatrixXd>& samples, int factor) {
  FATMC_CHECK(factor >= 1, "a factor of at least 1");
  if (factor == 1) return samples;
  const int half = kHalfLengthPerFactor * factor;
  const Eigen::Index n = samples.rows();
  FATMC_CHECK(n > half, "more samples than half the filter");
  const Eigen::VectorXd taps = low_pass(half, factor);
  Eigen::MatrixXd out(1 + (n - 1) / factor, samples.cols());
  Eigen::VectorXd longer(n + 2 * half);
  for (Eigen::Index c = 0; c < samples.cols(); ++c) {
    const auto x = samples.col(c);
    longer.segment(half, n) = x;
    for (Eigen::Index i = 1; i <= half; ++i) {
      longer(half - i) = 2.0 * x(0) - x(i);
      longer(half + n - 1 + i) = 2.0 * x(n - 1) - x(n - 1 - i);
    }
    for (Eigen::Index i = 0; i < out.rows(); ++i)
      out(i, c) = taps.dot(longer.segment(i * factor, 2 * half + 1));
  }
  return out;
}

}  // namespace fatmc
