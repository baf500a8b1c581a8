#include "core/stats/sensitivity.h"

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <numeric>

#include "core/base/check.h"
#include "core/random/random_stream.h"
#include "core/stats/empirical.h"

namespace fatmc {
namespace {

constexpr int kHighestDegree = 8;
constexpr std::size_t kTrialsPerDegree = 8;
constexpr std::size_t kFewestTrials = 25;

bool is_constant(std::span<const double> values) {
  return std::all_of(values.begin(), values.end(), [&](double v) { return v == values[0]; });
}

double correlation(std::span<const double> x, std::span<const double> y) {
  const double n = static_cast<double>(x.size());
  const double mean_x = std::accumulate(x.begin(), x.end(), 0.0) / n;
  const double mean_y = std::accumulate(y.begin(), y.end(), 0.0) / n;
  double xx = 0.0, yy = 0.0, xy = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    xx += (x[i] - mean_x) * (x[i] - mean_x);
    yy += (y[i] - mean_y) * (y[i] - mean_y);
    xy += (x[i] - mean_x) * (y[i] - mean_y);
  }
  return std::clamp(xy / std::sqrt(xx * yy), -1.0, 1.0);
}

// Regression of y on P_0 ... P_d of the rank, with weights that a bootstrap draws.
class RankRegression {
 public:
  RankRegression(std::span<const double> x, std::span<const double> y, int degree)
      : columns_(static_cast<std::size_t>(degree) + 1), basis_(x.size() * columns_) {
    const double mean = std::accumulate(y.begin(), y.end(), 0.0) / static_cast<double>(y.size());
    for (const double value : y) y_.push_back(value - mean);  // sums of squares keep their digits
    const std::vector<double> ranks = average_ranks(x);
    for (std::size_t i = 0; i < x.size(); ++i) {
      const double u = 2.0 * (ranks[i] - 0.5) / static_cast<double>(x.size()) - 1.0;
      double* p = &basis_[i * columns_];
      p[0] = 1.0;
      p[1] = u;
      for (std::size_t k = 2; k < columns_; ++k) {  // k P_k = (2k - 1) u P_{k-1} - (k - 1) P_{k-2}
        const double order = static_cast<double>(k);
        p[k] = ((2.0 * order - 1.0) * u * p[k - 1] - (order - 1.0) * p[k - 2]) / order;
      }
    }
  }

  struct Shares {
    double plain = 0.0, adjusted = 0.0;
  };

  // Weights are numbers of times that a trial counts; their sum is the number of trials.
  [[nodiscard]] Shares shares(std::span<const double> weights) const {
    const std::size_t m = columns_;
    std::vector<double> gram(m * m, 0.0), right(m, 0.0);
    double square = 0.0;
    for (std::size_t i = 0; i < y_.size(); ++i) {
      const double w = weights[i];
      if (w == 0.0) continue;
      const double* p = &basis_[i * m];
      square += w * y_[i] * y_[i];
      for (std::size_t a = 0; a < m; ++a) {
        right[a] += w * p[a] * y_[i];
        for (std::size_t b = 0; b <= a; ++b) gram[a * m + b] += w * p[a] * p[b];
      }
    }
    const double n = static_cast<double>(y_.size());
    const double total = square - right[0] * right[0] / n;
    const auto [explained, used] = explained_square(gram, right);
    const double rest = std::max(0.0, square - explained);
    if (!(total > 0.0)) return {};
    return {1.0 - rest / total, 1.0 - rest / (n - static_cast<double>(used)) / (total / (n - 1.0))};
  }

 private:
  // rᵀ G⁻¹ r and the rank of G, by Cholesky's factorisation; a column that adds nothing (few distinct x) is
  // left out.
  [[nodiscard]] std::pair<double, std::size_t> explained_square(std::vector<double>& gram,
                                                                const std::vector<double>& right) const {
    const std::size_t m = columns_;
    std::vector<double> z(m, 0.0);
    double explained = 0.0;
    std::size_t used = 0;
    for (std::size_t j = 0; j < m; ++j) {
      double pivot = gram[j * m + j], value = right[j];
      const double size = pivot;
      for (std::size_t k = 0; k < j; ++k) {
        pivot -= gram[j * m + k] * gram[j * m + k];
        value -= gram[j * m + k] * z[k];
      }
      const bool dependent = !(pivot > 1e-9 * size);
      const double root = dependent ? 1.0 : std::sqrt(pivot);
      for (std::size_t i = j + 1; i < m; ++i) {
        for (std::size_t k = 0; k < j; ++k) gram[i * m + j] -= gram[i * m + k] * gram[j * m + k];
        gram[i * m + j] = dependent ? 0.0 : gram[i * m + j] / root;
      }
      if (dependent) continue;
      z[j] = value / root;
      explained += z[j] * z[j];
      ++used;
    }
    return {explained, used};
  }

  std::size_t columns_;
  std::vector<double> basis_, y_;
};

}  // namespace

std::vector<double> average_ranks(std::span<const double> values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  std::vector<double> ranks(values.size());
  for (std::size_t first = 0; first < order.size();) {
    std::size_t last = first;
    while (last < order.size() && values[order[last]] == values[order[first]]) ++last;
    const double shared = 0.5 * static_cast<double>(first + last + 1);
    for (std::size_t i = first; i < last; ++i) ranks[order[i]] = shared;
    first = last;
  }
  return ranks;
}

std::optional<Estimate> rank_correlation(std::span<const double> x, std::span<const double> y, double level) {
  FATMC_CHECK(x.size() == y.size() && level > 0.0 && level < 1.0, "pairs and a level");
  if (x.size() < 4 || is_constant(x) || is_constant(y)) return std::nullopt;
  const double rho = correlation(average_ranks(x), average_ranks(y));
  const double quantile = boost::math::quantile(boost::math::normal(), 0.5 + 0.5 * level);
  const double half = quantile * std::sqrt((1.0 + 0.5 * rho * rho) / static_cast<double>(x.size() - 3));
  const double z = std::atanh(rho);
  return Estimate{rho, {std::tanh(z - half), std::tanh(z + half)}};
}

int share_degree(std::size_t n) {
  return std::clamp(static_cast<int>(n / kTrialsPerDegree), 1, kHighestDegree);
}

std::optional<Estimate> first_order_share(std::span<const double> x, std::span<const double> y,
                                          const ShareOptions& options) {
  FATMC_CHECK(x.size() == y.size() && options.resamples >= 40, "pairs and resamples");
  const std::size_t n = x.size();
  if (n < kFewestTrials || is_constant(x) || is_constant(y)) return std::nullopt;
  const RankRegression regression(x, y, share_degree(n));
  std::vector<double> weights(n, 1.0);
  const RankRegression::Shares own = regression.shares(weights);
  std::vector<double> deviations;
  for (int b = 0; b < options.resamples; ++b) {
    RandomStream stream(TrialSeed{options.seed, 0, 0, static_cast<std::uint64_t>(b)}, "bootstrap");
    std::fill(weights.begin(), weights.end(), 0.0);
    for (std::size_t i = 0; i < n; ++i) {
      weights[static_cast<std::size_t>(stream.uniform() * static_cast<double>(n))] += 1.0;
    }
    deviations.push_back(regression.shares(weights).adjusted - own.plain);
  }
  const EmpiricalCdf law(std::move(deviations));
  const double tail = 0.5 - 0.5 * options.level;
  const Interval interval{std::clamp(own.adjusted + law.quantile(tail), 0.0, 1.0),
                          std::clamp(own.adjusted + law.quantile(1.0 - tail), 0.0, 1.0)};
  return Estimate{own.adjusted, interval};
}

}  // namespace fatmc
