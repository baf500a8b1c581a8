#include "core/discrepancy/residual_response.h"

#include <Eigen/QR>
#include <algorithm>
#include <boost/math/distributions/beta.hpp>
#include <boost/math/distributions/gamma.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/special_functions/digamma.hpp>
#include <boost/math/special_functions/trigamma.hpp>
#include <cmath>

namespace fatmc {
namespace {

namespace math = boost::math;
using Matrix = Eigen::MatrixXcd;
using Vector = Eigen::VectorXcd;

/// Polynomials of one window: bins x (order + 1), in the scaled distance from its middle.
Matrix powers(int bins, int order) {
  Matrix out(bins, order + 1);
  for (int i = 0; i < bins; ++i) {
    const double x = 2.0 * i / (bins - 1.0) - 1.0;
    double power = 1.0;
    for (int g = 0; g <= order; ++g, power *= x) out(i, g) = power;
  }
  return out;
}

/// Columns for the transient and the inputs of `set`.
Matrix regressor(const Matrix& polynomial, const Matrix& input, const std::vector<int>& set) {
  const Eigen::Index r = polynomial.cols();
  Matrix out(polynomial.rows(), r * static_cast<Eigen::Index>(set.size()) + 1);
  out.col(0).setOnes();
  for (std::size_t s = 0; s < set.size(); ++s) {
    out.middleCols(r * static_cast<Eigen::Index>(s) + 1, r) = input.col(set[s]).asDiagonal() * polynomial;
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
  for (Eigen::Index w = 0; w < count; ++w) {
    out.push_back({bins * w / count, static_cast<int>(bins * (w + 1) / count - bins * w / count)});
  }
  return out;
}

std::vector<int> all_but(int count, int left_out) {
  std::vector<int> out;
  for (int j = 0; j < count; ++j) {
    if (j != left_out) out.push_back(j);
  }
  return out;
}

/// Normal deviation with the tail that a sum of -log b has beyond `sum`. For whole R the -log b are sums of exponential variables,
/// so that their sum is close to the gamma law of its mean and variance; few windows are too skewed for a normal one. 37 at
/// most, where the tail leaves the range of a double.
double sigma_of(double sum, double mean, double variance) {
  const math::gamma_distribution<> law(mean * mean / variance, variance / mean);
  const double tail = math::cdf(math::complement(law, std::max(sum, 1e-12)));
  if (tail < 1e-300) return 37.0;
  return tail < 1.0 ? math::quantile(math::complement(math::normal(), tail)) : -37.0;
}

/// The work on one output.
class OutputError {
 public:
  OutputError(const std::vector<double>& frequency_hz, const std::vector<Window>& windows,
              const Matrix& input, Vector error, const ResidualOptions& options)
      : frequency_hz_(frequency_hz),
        windows_(windows),
        input_(input),
        error_(std::move(error)),
        options_(options),
        inputs_(static_cast<int>(input.cols())),
        unknowns_((options.order + 1) * inputs_ + 1) {
    for (const Window& w : windows_) {
      full_.push_back(fitted(w, all_but(inputs_, -1)).residual);
      floor_ += full_.back() * w.bins / (w.bins - unknowns_);
    }
  }
  [[nodiscard]] double floor() const { return floor_; }

  /// What element j explains; bands beyond the limit go to `places`, windows in which it acts are remembered.
  double test(int output, int j, int bands, double limit, std::vector<ResidualPlace>& places,
              bool& significant) {
    acts_.resize(static_cast<std::size_t>(inputs_), std::vector<char>(windows_.size(), 0));
    double explained = 0.0;
    for (int b = 0; b < bands; ++b) {
      const std::size_t first =
          windows_.size() * static_cast<std::size_t>(b) / static_cast<std::size_t>(bands);
      const std::size_t last =
          windows_.size() * static_cast<std::size_t>(b + 1) / static_cast<std::size_t>(bands);
      double sum = 0.0, mean = 0.0, variance = 0.0, share = 0.0, energy = 0.0;
      for (std::size_t w = first; w < last; ++w) {
        const double without = fitted(windows_[w], all_but(inputs_, j)).residual;
        const double freedom = windows_[w].bins - unknowns_, more = freedom + options_.order + 1;
        const double ratio = std::clamp(full_[w] / std::max(without, 1e-300), 1e-300, 1.0);
        sum -= std::log(ratio);
        mean += math::digamma(more) - math::digamma(freedom);
        variance += math::trigamma(freedom) - math::trigamma(more);
        share += without - full_[w];
        energy += error_.segment(windows_[w].first, windows_[w].bins).squaredNorm();
        const math::beta_distribution<> law(freedom, options_.order + 1.0);
        acts_[static_cast<std::size_t>(j)][w] = math::cdf(law, ratio) < options_.window_level ? 1 : 0;
      }
      explained += share;
      const double sigma = sigma_of(sum, mean, variance);
      if (sigma <= limit) continue;
      significant = true;
      const Window& end = windows_[last - 1];
      places.push_back({output, j, frequency_hz_[static_cast<std::size_t>(windows_[first].first)],
                        frequency_hz_[static_cast<std::size_t>(end.first + end.bins - 1)], sigma,
                        share / energy});
    }
    return explained;
  }

  /// Responses of the elements `taken`, fitted together in the windows where they act, into their columns of
  /// `response`; the energy that they leave.
  double repair(int output, int outputs, const std::vector<int>& taken, Matrix& response) const {
    Vector rest = error_;
    for (std::size_t w = 0; w < windows_.size(); ++w) {
      std::vector<int> set;
      for (const int j : taken) {
        if (acts_[static_cast<std::size_t>(j)][w] != 0) set.push_back(j);
      }
      if (set.empty()) continue;
      const Window& at = windows_[w];
      const Matrix polynomial = powers(at.bins, options_.order);
      const Fit found = fitted(at, set);
      const Eigen::Index r = polynomial.cols();
      for (std::size_t s = 0; s < set.size(); ++s) {
        const Vector h = polynomial * found.coefficients.segment(r * static_cast<Eigen::Index>(s) + 1, r);
        response.col(static_cast<Eigen::Index>(set[s]) * outputs + output).segment(at.first, at.bins) = h;
        rest.segment(at.first, at.bins) -= h.cwiseProduct(input_.col(set[s]).segment(at.first, at.bins));
      }
    }
    return rest.squaredNorm();
  }

 private:
  [[nodiscard]] Fit fitted(const Window& w, const std::vector<int>& set) const {
    return fit(regressor(powers(w.bins, options_.order), input_.middleRows(w.first, w.bins), set),
               error_.segment(w.first, w.bins));
  }

  const std::vector<double>& frequency_hz_;
  const std::vector<Window>& windows_;
  const Matrix& input_;
  Vector error_;
  const ResidualOptions& options_;
  int inputs_, unknowns_;
  std::vector<double> full_;
  double floor_ = 0.0;
  std::vector<std::vector<char>> acts_;
};

}  // namespace

Result<ResidualResponse> fit_residual_response(const std::vector<double>& frequency_hz,
                                               const Eigen::Ref<const Matrix>& error,
                                               const Eigen::Ref<const Matrix>& output,
                                               const Eigen::Ref<const Matrix>& input_bins,
                                               const ResidualOptions& options) {
  const Matrix input = input_bins;
  const int inputs = static_cast<int>(input.cols()), outputs = static_cast<int>(error.cols());
  const int bins = (options.order + 1) * inputs + 1 + options.spare;
  if (error.rows() < 2 * bins) {
    return fail("the band holds " + std::to_string(error.rows()) + " bins, write one with two windows of " +
                std::to_string(bins) + " at least");
  }
  const std::vector<Window> windows = cut(error.rows(), bins);
  const int bands = std::min(options.bands, static_cast<int>(windows.size()));
  ResidualResponse out;
  out.frequency_hz = frequency_hz;
  out.limit = math::quantile(math::complement(math::normal(), options.level / (bands * inputs * outputs)));
  out.response.setZero(error.rows(), static_cast<Eigen::Index>(outputs) * inputs);
  out.before = error.colwise().squaredNorm().transpose();
  out.output_energy = output.colwise().squaredNorm().transpose();
  out.after = out.before;
  out.floor.setZero(outputs);
  for (int i = 0; i < outputs; ++i) {
    OutputError one(frequency_hz, windows, input, error.col(i), options);
    out.floor[i] = one.floor();
    std::vector<std::pair<double, int>> candidates;
    for (int j = 0; j < inputs; ++j) {
      bool significant = false;
      const double explained = one.test(i, j, bands, out.limit, out.places, significant);
      if (significant && explained >= options.material * out.before[i]) candidates.emplace_back(explained, j);
    }
    std::sort(candidates.rbegin(), candidates.rend());
    std::vector<int> taken;
    for (const auto& [explained, j] : candidates) {
      taken.push_back(j);
      out.elements.emplace_back(i, j);
      out.explained.push_back(explained / out.before[i]);
    }
    if (!taken.empty()) out.after[i] = one.repair(i, outputs, taken, out.response);
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
