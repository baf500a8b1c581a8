#include "core/stats/lawley_hotelling.h"

#include <algorithm>
#include <boost/math/distributions/fisher_f.hpp>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "core/base/check.h"

namespace fatmc {
namespace {

using Complex = std::complex<double>;

/// Of the contour. More would magnify rounding (e^(0.17 nodes)), fewer leave the error of 5 x 5 at large q
/// above 1e-9.
constexpr int kNodes = 48, kCoarseNodes = 36;

/// Determinant of the n x n matrix `m` (rows one after the other), by elimination with partial pivoting.
Complex determinant(std::vector<Complex>& m, int n) {
  Complex det = 1.0;
  const auto at = [&](int i, int j) -> Complex& { return m[static_cast<std::size_t>(i * n + j)]; };
  for (int c = 0; c < n; ++c) {
    int pivot = c;
    for (int i = c + 1; i < n; ++i) {
      if (std::abs(at(i, c)) > std::abs(at(pivot, c))) pivot = i;
    }
    if (at(pivot, c) == 0.0) return 0.0;
    if (pivot != c) {
      for (int j = 0; j < n; ++j) std::swap(at(pivot, j), at(c, j));
      det = -det;
    }
    det *= at(c, c);
    for (int i = c + 1; i < n; ++i) {
      const Complex factor = at(i, c) / at(c, c);
      for (int j = c; j < n; ++j) at(i, j) -= factor * at(c, j);
    }
  }
  return det;
}

}  // namespace

ComplexLawleyHotelling::ComplexLawleyHotelling(int n_out, int n_in, double q) : q_(q) {
  FATMC_CHECK(n_out >= 1 && n_in >= 1 && q >= n_out, "a regular covariance estimate");
  r_ = std::min(n_out, n_in);
  const int s = std::max(n_out, n_in);
  const double nu = n_out <= n_in ? q : q + n_in - n_out;
  a_ = s - r_;
  b_ = nu + s;
  // Ends where the largest integrand, f^(2r-2) times the weight, has fallen to e^-40 of its size.
  const double decades = 40.0 + 4.0 * (a_ + 2 * r_);
  first_ = std::log(std::min(1.0, s / nu)) - 40.0 / (a_ + 1.0);
  step_ = 0.0625;
  const double last = std::log(std::expm1(decades / (nu - r_ + 1.0))) + 1.0;
  count_ = static_cast<int>((last - first_) / step_) + 2;

  // Stieltjes: the recurrence of the polynomials orthonormal for the weight, on the very nodes of the rule.
  std::vector<double> x, w;
  double peak = -std::numeric_limits<double>::infinity();
  for (int n = 0; n < count_; ++n) {
    const double u = first_ + n * step_;
    x.push_back(std::exp(u));
    w.push_back((a_ + 1.0) * u - b_ * std::log1p(x.back()));
    peak = std::max(peak, w.back());
  }
  double total = 0.0;
  for (double& value : w) total += value = std::exp(value - peak);
  for (double& value : w) value /= total;
  scale_ = peak + std::log(total * step_);
  std::vector<double> before(x.size(), 0.0), now(x.size(), 1.0);
  for (int i = 0; i + 1 < r_; ++i) {
    double alpha = 0.0;
    for (std::size_t n = 0; n < x.size(); ++n) alpha += w[n] * x[n] * now[n] * now[n];
    double norm = 0.0;
    for (std::size_t n = 0; n < x.size(); ++n) {
      const double next = (x[n] - alpha) * now[n] - (i > 0 ? beta_.back() : 0.0) * before[n];
      before[n] = now[n];
      now[n] = next;
      norm += w[n] * next * next;
    }
    for (double& value : now) value /= std::sqrt(norm);
    alpha_.push_back(alpha);
    beta_.push_back(std::sqrt(norm));
  }
}

void ComplexLawleyHotelling::polynomials(Complex f, Complex* p) const {
  p[0] = 1.0;
  for (int i = 0; i + 1 < r_; ++i) {
    const auto k = static_cast<std::size_t>(i);
    p[i + 1] = ((f - alpha_[k]) * p[i] - (i > 0 ? beta_[k - 1] * p[i - 1] : 0.0)) / beta_[k];
  }
}

Complex ComplexLawleyHotelling::laplace(Complex z) const {
  // No more than keeps exp(-z f) falling: the other factor turns with the path, and faster the larger q is.
  constexpr double kFalls = 75.0 * std::numbers::pi / 180.0;
  const double angle = std::arg(z), turn = -std::copysign(std::max(0.0, std::abs(angle) - kFalls), angle);
  const Complex direction = std::polar(1.0, turn);
  std::vector<Complex> m(static_cast<std::size_t>(r_ * r_)), p(static_cast<std::size_t>(r_));
  for (int n = 0; n < count_; ++n) {
    const double u = first_ + n * step_;
    const Complex f = direction * std::exp(u);
    const Complex exponent = (a_ + 1.0) * Complex(u, turn) - b_ * std::log(1.0 + f) - z * f - scale_;
    if (exponent.real() < -90.0) continue;
    const Complex weight = step_ * std::exp(exponent);
    polynomials(f, p.data());
    for (int i = 0; i < r_; ++i) {
      for (int j = 0; j <= i; ++j) {
        m[static_cast<std::size_t>(i * r_ + j)] +=
            weight * p[static_cast<std::size_t>(i)] * p[static_cast<std::size_t>(j)];
      }
    }
  }
  for (int i = 0; i < r_; ++i) {
    for (int j = 0; j < i; ++j)
      m[static_cast<std::size_t>(j * r_ + i)] = m[static_cast<std::size_t>(i * r_ + j)];
  }
  return determinant(m, r_);
}

// F(t) = 1/(2 pi j) int exp(w) phi(w/t)/w dw, midpoint rule in theta on w(theta), half of it by symmetry.
double ComplexLawleyHotelling::invert(double t, int node_count) const {
  const double nodes = node_count;
  double sum = 0.0;
  for (int k = 0; k < node_count / 2; ++k) {
    const double theta = (2 * k + 1) * std::numbers::pi / nodes;
    const double sine = std::sin(0.6407 * theta), cotangent = std::cos(0.6407 * theta) / sine;
    const Complex w = nodes * Complex(0.5017 * theta * cotangent - 0.6122, 0.2645 * theta);
    const Complex slope =
        nodes * Complex(0.5017 * cotangent - 0.5017 * 0.6407 * theta / (sine * sine), 0.2645);
    sum += (std::exp(w) * slope * laplace(w / t) / w).imag();
  }
  return 2.0 * sum / nodes;
}

ComplexLawleyHotelling::Value ComplexLawleyHotelling::distribution(double t) const {
  if (!(t > 0.0)) return {0.0, 0.0};
  const double fine = invert(t / q_, kNodes), coarse = invert(t / q_, kCoarseNodes);
  return {std::clamp(fine, 0.0, 1.0), std::abs(fine - coarse) + 1e-13};
}

ComplexLawleyHotelling::Value ComplexLawleyHotelling::quantile(double p) const {
  FATMC_CHECK(p >= 0.0 && p <= 1.0 - 1e-9, "a probability, 0 to 1 - 1e-9");
  if (p == 0.0) return {0.0, 0.0};
  double high = 1.0;
  while (invert(high / q_, kNodes) < p) high *= 2.0;  // ends: the law has no mass at infinity
  double low = high;
  while (invert(low / q_, kNodes) > p) low *= 0.5;
  std::uintmax_t iterations = 60;
  const auto bracket =
      boost::math::tools::toms748_solve([&](double t) { return invert(t / q_, kNodes) - p; }, low, high,
                                        boost::math::tools::eps_tolerance<double>(40), iterations);
  const double t = 0.5 * (bracket.first + bracket.second);
  const double around = 1e-3 * t;
  const double density =
      (invert((t + around) / q_, kNodes) - invert((t - around) / q_, kNodes)) / (2.0 * around);
  return {t, distribution(t).error / density + std::abs(bracket.second - bracket.first)};
}

double printed_joint_limit(double p, int n_out, int n_in, double q) {
  const double n_1 = 2.0 * n_in * n_out, n_2 = 2.0 * q - n_1 + 2.0;
  FATMC_CHECK(n_2 > 0.0, "degrees of freedom as T counts them");
  return n_1 * q / n_2 * boost::math::quantile(boost::math::fisher_f(n_1, n_2), p);
}

}  // namespace fatmc
