#include "core/signal/crest_factor.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "core/base/check.h"
#include "core/signal/dft.h"

namespace fatmc {
namespace {

using Complex = std::complex<double>;

/// x / max|x| for some phases, and what the least-squares problem of exponent p looks like there.
class PowerNorm {
 public:
  explicit PowerNorm(const Multisine& start)
      : start_(start),
        dft_(start.period_samples()),
        power_(static_cast<std::size_t>(start.period_samples())) {}

  [[nodiscard]] std::vector<double> signal(const Eigen::VectorXd& phases) const {
    return Multisine(start_.period_samples(), start_.lines(), start_.amplitudes(),
                     {phases.begin(), phases.end()})
        .period();
  }

  /// sum (x/peak)^(2p)
  static double cost(const std::vector<double>& x, double peak, int p) {
    double sum = 0.0;
    for (const double v : x) sum += std::pow(v * v / (peak * peak), p);
    return sum;
  }

  /// Gradient/2 and Gauss-Newton matrix of `cost`.
  void expand(const std::vector<double>& x, double peak, int p, const Eigen::VectorXd& phases,
              Eigen::VectorXd& gradient, Eigen::MatrixXd& matrix) {
    const auto& lines = start_.lines();
    const auto count = static_cast<Eigen::Index>(lines.size());
    for (std::size_t n = 0; n < x.size(); ++n) {
      const double v = x[n] / peak;
      power_[n] = v * std::pow(v * v, p - 1);
    }
    const std::vector<Complex> slope = spectrum(lines.back());
    for (std::size_t n = 0; n < x.size(); ++n) power_[n] = std::pow(x[n] * x[n] / (peak * peak), p - 1);
    const std::vector<Complex> w = spectrum(std::min(2 * lines.back(), start_.period_samples() / 2));
    const auto at = [&](int m) {  // W(m), m up to the period
      const int half = start_.period_samples() / 2;
      return m <= half ? w[static_cast<std::size_t>(m)]
                       : std::conj(w[static_cast<std::size_t>(start_.period_samples() - m)]);
    };
    gradient.resize(count);
    matrix.resize(count, count);
    for (Eigen::Index k = 0; k < count; ++k) {
      const auto ku = static_cast<std::size_t>(k);
      const double a_k = p * start_.amplitudes()[ku] / peak;
      const Complex e_k = std::polar(1.0, phases(k));
      gradient(k) = -a_k * (e_k * std::conj(slope[static_cast<std::size_t>(lines[ku])])).imag();
      for (Eigen::Index l = 0; l <= k; ++l) {
        const auto lu = static_cast<std::size_t>(l);
        const double a_l = p * start_.amplitudes()[lu] / peak;
        const Complex e_l = std::polar(1.0, phases(l));
        matrix(k, l) = 0.5 * a_k * a_l *
                       (e_k * std::conj(e_l) * std::conj(at(lines[ku] - lines[lu])) -
                        e_k * e_l * std::conj(at(lines[ku] + lines[lu])))
                           .real();
        matrix(l, k) = matrix(k, l);
      }
    }
  }

 private:
  /// Unscaled DFT of power_, bins 0 ... last.
  std::vector<Complex> spectrum(int last) const {
    std::vector<Complex> bins(static_cast<std::size_t>(last) + 1);
    dft_.transform(power_, bins);
    const double scale = std::sqrt(static_cast<double>(start_.period_samples()));
    for (Complex& bin : bins) bin *= scale;
    return bins;
  }

  const Multisine& start_;
  RealDft dft_;
  std::vector<double> power_;
};

double peak_of(const std::vector<double>& x) {
  double peak = 0.0;
  for (const double v : x) peak = std::max(peak, std::abs(v));
  return peak;
}

}  // namespace

Multisine schroeder_phases(int period_samples, std::vector<int> lines, std::vector<double> amplitudes) {
  double total = 0.0;
  for (const double a : amplitudes) total += a * a;
  FATMC_CHECK(total > 0.0, "a signal");
  std::vector<double> phases;
  double phase = 0.0, share = 0.0;  // phi_(k+1) - phi_k = -2 pi sum_(l<=k) P_l
  for (const double a : amplitudes) {
    phases.push_back(std::remainder(phase, 2.0 * std::numbers::pi));
    share += a * a / total;
    phase -= 2.0 * std::numbers::pi * share;
  }
  return {period_samples, std::move(lines), std::move(amplitudes), std::move(phases)};
}

LowCrest lower_crest_factor(const Multisine& start, const CrestOptions& options) {
  FATMC_CHECK(options.steps >= 1 && options.largest_exponent >= 2, "at least one step at p = 2");
  PowerNorm norm(start);
  Eigen::VectorXd phases = Eigen::Map<const Eigen::VectorXd>(
      start.phases().data(), static_cast<Eigen::Index>(start.phases().size()));
  Eigen::VectorXd best = phases;
  std::vector<double> x = norm.signal(phases);
  LowCrest out{start, crest_factor(x), crest_factor(x), 0};
  if (!(out.start > 0.0)) return out;
  Eigen::VectorXd gradient;
  Eigen::MatrixXd matrix;
  for (int p = 2; p <= options.largest_exponent; p *= 2) {
    double damping = 1e-2, peak = peak_of(x), cost = PowerNorm::cost(x, peak, p);
    bool expand = true;
    for (int step = 0; step < options.steps; ++step) {
      if (expand) norm.expand(x, peak, p, phases, gradient, matrix);
      Eigen::MatrixXd damped = matrix;
      damped.diagonal() += damping * matrix.diagonal();
      damped.diagonal().array() += 1e-12 * matrix.trace();  // lines without amplitude
      const Eigen::VectorXd next = phases - damped.llt().solve(gradient);
      const std::vector<double> y = norm.signal(next);
      const double next_cost = PowerNorm::cost(y, peak, p);
      ++out.steps;
      expand = next_cost < cost;
      if (!expand) {
        damping *= 4.0;
        continue;
      }
      const bool converged = next_cost > (1.0 - 1e-4) * cost;
      damping = std::max(damping / 3.0, 1e-9);
      phases = next;
      x = y;
      peak = peak_of(x);
      cost = PowerNorm::cost(x, peak, p);
      if (const double crest = crest_factor(x); crest < out.crest_factor) {
        out.crest_factor = crest;
        best = phases;
      }
      if (converged) break;
    }
  }
  out.signal =
      Multisine(start.period_samples(), start.lines(), start.amplitudes(), {best.begin(), best.end()});
  return out;
}

}  // namespace fatmc
