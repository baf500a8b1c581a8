#include "core/discrepancy/residual_response.h"

#include <Eigen/QR>
#include <algorithm>
#include <boost/math/distributions/fisher_f.hpp>
#include <cmath>

namespace fatmc {
namespace {

using Matrix = Eigen::MatrixXcd;
using Vector = Eigen::VectorXcd;

/// Polynomials of one window: bins x (order + 1), in the scaled distance from its middle.
Eigen::MatrixXd powers(int bins, int order) {
  Eigen::MatrixXd out(bins, order + 1);
  for (int i = 0; i < bins; ++i) {
    const double x = 2.0 * i / (bins - 1.0) - 1.0;
    double power = 1.0;
    for (int g = 0; g <= order; ++g, power *= x) out(i, g) = power;
  }
  return out;
}

/// Columns for the transient and the inputs of `set`.
Matrix regressor(const Eigen::MatrixXd& polynomial, const Matrix& input, const std::vector<int>& set) {
  const Eigen::Index r = polynomial.cols();
  Matrix out(polynomial.rows(), r * static_cast<Eigen::Index>(set.size() + 1));
  out.leftCols(r) = polynomial.cast<std::complex<double>>();
  for (std::size_t s = 0; s < set.size(); ++s) {
    out.middleCols(r * static_cast<Eigen::Index>(s + 1), r) =
        input.col(set[s]).asDiagonal() * polynomial.cast<std::complex<double>>();
  }
  return out;
}

struct Fit {
  Vector coefficients;
  double residual = 0.0;  ///< sum of squares
};

Fit fit(const Matrix& columns, const Vector& error) {
  const Eigen::ColPivHouseholderQR<Matrix> qr(columns);
  Fit out;
  out.coefficients = qr.solve(error);
  out.residual = (error - columns * out.coefficients).squaredNorm();
  return out;
}

/// A window's place among the bins.
struct Window {
  Eigen::Index first = 0;
  int bins = 0;
};

std::vector<Window> cut(Eigen::Index bins, int window) {
  std::vector<Window> out;
  const Eigen::Index count = bins / window;
  for (Eigen::Index w = 0; w < count; ++w)
    out.push_back({bins * w / count, static_cast<int>(bins * (w + 1) / count - bins * w / count)});
  return out;
}

/// Residual of an output over all windows with the inputs of `set`.
double residual_with(const std::vector<Window>& windows, const Matrix& error, const Matrix& input, int output,
                     const std::vector<int>& set, int order) {
  double sum = 0.0;
  for (const Window& w : windows) {
    const Matrix columns = regressor(powers(w.bins, order), input.middleRows(w.first, w.bins), set);
    sum += fit(columns, error.col(output).segment(w.first, w.bins)).residual;
  }
  return sum;
}

}  // namespace

Result<ResidualResponse> fit_residual_response(const std::vector<double>& frequency_hz,
                                               const Eigen::Ref<const Matrix>& error,
                                               const Eigen::Ref<const Matrix>& output,
                                               const Eigen::Ref<const Matrix>& input,
                                               const ResidualOptions& options) {
  const int inputs = static_cast<int>(input.cols()), outputs = static_cast<int>(error.cols());
  const int unknowns = (options.order + 1) * (inputs + 1);
  if (options.window < 2 * unknowns) {
    return fail("a window of " + std::to_string(options.window) + " bins has too few for " +
                std::to_string(unknowns) + " unknowns");
  }
  if (error.rows() < 2 * options.window)
    return fail("the band holds fewer than two windows of " + std::to_string(options.window) + " bins");
  ResidualResponse out;
  out.frequency_hz = frequency_hz;
  const std::vector<Window> windows = cut(error.rows(), options.window);
  out.tests = static_cast<int>(windows.size()) * inputs * outputs;
  out.response.setZero(error.rows(), static_cast<Eigen::Index>(outputs) * inputs);
  out.before = error.colwise().squaredNorm().transpose();
  out.output_energy = output.colwise().squaredNorm().transpose();
  out.after.resize(outputs);
  out.floor.setZero(outputs);

  std::vector<int> all;
  for (int j = 0; j < inputs; ++j) all.push_back(j);
  for (int i = 0; i < outputs; ++i) {
    std::vector<char> significant(static_cast<std::size_t>(inputs), 0);
    for (const Window& w : windows) {
      const Eigen::MatrixXd polynomial = powers(w.bins, options.order);
      const Matrix u = input.middleRows(w.first, w.bins);
      const Vector e = error.col(i).segment(w.first, w.bins);
      const double full = fit(regressor(polynomial, u, all), e).residual;
      const double freedom = w.bins - unknowns;
      out.floor[i] += full * w.bins / freedom;
      for (int j = 0; j < inputs; ++j) {
        std::vector<int> others = all;
        others.erase(others.begin() + j);
        const double without = fit(regressor(polynomial, u, others), e).residual;
        const double f = (without - full) / (options.order + 1) / std::max(full / freedom, 1e-300);
        const boost::math::fisher_f law(2.0 * (options.order + 1), 2.0 * freedom);
        const double p = boost::math::cdf(boost::math::complement(law, std::max(0.0, f)));
        if (p * out.tests > options.level) continue;
        significant[static_cast<std::size_t>(j)] = 1;
        out.places.push_back({i, j, frequency_hz[static_cast<std::size_t>(w.first)],
                              frequency_hz[static_cast<std::size_t>(w.first + w.bins - 1)], p,
                              (without - full) / e.squaredNorm()});
      }
    }
    // Forward: the element that explains most of the output's error, as long as it is significant and material.
    std::vector<int> taken;
    double left = residual_with(windows, error, input, i, taken, options.order);
    const double start = left;
    for (;;) {
      int best = -1;
      double least = left;
      for (int j = 0; j < inputs; ++j) {
        if (significant[static_cast<std::size_t>(j)] == 0 ||
            std::find(taken.begin(), taken.end(), j) != taken.end())
          continue;
        std::vector<int> more = taken;
        more.push_back(j);
        const double with = residual_with(windows, error, input, i, more, options.order);
        if (with < least) {
          least = with;
          best = j;
        }
      }
      if (best < 0 || left - least < options.material * start) break;
      taken.push_back(best);
      out.elements.emplace_back(i, best);
      out.explained.push_back((left - least) / out.before[i]);
      left = least;
    }
    Vector rest = error.col(i);
    for (const Window& w : windows) {
      const Eigen::MatrixXd polynomial = powers(w.bins, options.order);
      const Matrix u = input.middleRows(w.first, w.bins);
      const Fit found = fit(regressor(polynomial, u, taken), error.col(i).segment(w.first, w.bins));
      const Eigen::Index r = polynomial.cols();
      for (std::size_t s = 0; s < taken.size(); ++s) {
        const Vector h = polynomial.cast<std::complex<double>>() *
                         found.coefficients.segment(r * static_cast<Eigen::Index>(s + 1), r);
        out.response.col(static_cast<Eigen::Index>(taken[s]) * outputs + i).segment(w.first, w.bins) = h;
        rest.segment(w.first, w.bins) -= h.cwiseProduct(u.col(taken[s]));
      }
    }
    out.after[i] = rest.squaredNorm();
  }
  return out;
}

Matrix apply_residual_response(const ResidualResponse& fit, const std::vector<double>& frequency_hz,
                               const Eigen::Ref<const Matrix>& error, const Eigen::Ref<const Matrix>& input) {
  Matrix out = error;
  const auto& grid = fit.frequency_hz;
  const Eigen::Index outputs = error.cols();
  for (std::size_t m = 0; m < frequency_hz.size(); ++m) {
    const auto above = std::lower_bound(grid.begin(), grid.end(), frequency_hz[m]);
    const auto hi =
        std::min<std::ptrdiff_t>(above - grid.begin(), static_cast<std::ptrdiff_t>(grid.size()) - 1);
    const auto lo = std::max<std::ptrdiff_t>(0, hi - 1);
    const double span = grid[static_cast<std::size_t>(hi)] - grid[static_cast<std::size_t>(lo)];
    const double share =
        span > 0.0 ? std::clamp((frequency_hz[m] - grid[static_cast<std::size_t>(lo)]) / span, 0.0, 1.0)
                   : 1.0;
    const auto at = static_cast<Eigen::Index>(m);
    for (const auto& [i, j] : fit.elements) {
      const Eigen::Index column = static_cast<Eigen::Index>(j) * outputs + i;
      const std::complex<double> h =
          (1.0 - share) * fit.response(lo, column) + share * fit.response(hi, column);
      out(at, i) -= h * input(at, j);
    }
  }
  return out;
}

}  // namespace fatmc
