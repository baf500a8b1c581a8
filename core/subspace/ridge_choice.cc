#include "core/subspace/ridge_choice.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace fatmc {
namespace {

constexpr double kStrongRobustShare = 0.95;  // gamma
constexpr int kSearchDecades = 12, kSearchPerDecade = 20;

struct RidgeSums {
  double rss = 0.0;       ///< ||Y - Xi Phi||^2
  double solution = 0.0;  ///< ||Xi||^2
  double trace = 0.0;     ///< sum f
  double strong = 0.0;    ///< sum (s_1 s/(s^2 + lambda^2))^2
};

RidgeSums ridge_sums(const RidgeSpectrum& problem, double lambda) {
  RidgeSums sums;
  sums.rss = problem.unexplained;
  for (Eigen::Index i = 0; i < problem.s.size(); ++i) {
    const double s = problem.s(i), denominator = s * s + lambda * lambda;
    if (denominator == 0.0) {
      sums.rss += problem.energy(i);
      continue;
    }
    const double filter = s * s / denominator, rest = lambda * lambda / denominator, gain = s / denominator;
    sums.rss += rest * rest * problem.energy(i);
    sums.solution += gain * gain * problem.energy(i);
    sums.trace += filter;
    sums.strong += gain * gain * problem.s(0) * problem.s(0);
  }
  return sums;
}

double cross_validation(const RidgeSpectrum& problem, double lambda, bool strong_robust) {
  const RidgeSums sums = ridge_sums(problem, lambda);
  const double m = problem.equations, left = 1.0 - sums.trace / m;
  if (left <= 0.0) return std::numeric_limits<double>::infinity();
  const double value = sums.rss / m / (left * left);
  return strong_robust ? value * (kStrongRobustShare + (1.0 - kStrongRobustShare) * sums.strong / m) : value;
}

std::vector<double> candidate_lambdas(double largest) {
  std::vector<double> out;
  for (int i = -kSearchDecades * kSearchPerDecade; i <= 0; ++i) {
    out.push_back(largest * std::pow(10.0, static_cast<double>(i) / kSearchPerDecade));
  }
  return out;
}

/// Signed curvature of the L-curve at inner points, by differences over log lambda; the corner is where it is
/// largest.
double corner(const RidgeSpectrum& problem, const std::vector<double>& lambdas) {
  std::vector<double> x, y;
  for (const double lambda : lambdas) {
    const RidgeSums sums = ridge_sums(problem, lambda);
    x.push_back(0.5 * std::log(std::max(sums.rss, std::numeric_limits<double>::min())));
    y.push_back(0.5 * std::log(std::max(sums.solution, std::numeric_limits<double>::min())));
  }
  double best = lambdas.front(), largest = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i + 1 < lambdas.size(); ++i) {
    const double dx = 0.5 * (x[i + 1] - x[i - 1]), dy = 0.5 * (y[i + 1] - y[i - 1]);
    const double ddx = x[i + 1] - 2.0 * x[i] + x[i - 1], ddy = y[i + 1] - 2.0 * y[i] + y[i - 1];
    const double speed = dx * dx + dy * dy;
    if (speed <= 0.0) continue;
    const double curvature = (dx * ddy - ddx * dy) / std::pow(speed, 1.5);
    if (curvature > largest) {
      largest = curvature;
      best = lambdas[i];
    }
  }
  return best;
}

}  // namespace

double chosen_lambda(const RidgeSpectrum& problem, Regularization rule) {
  const std::vector<double> lambdas = candidate_lambdas(problem.s(0));
  if (rule == Regularization::lcurve) return corner(problem, lambdas);
  double best = lambdas.front(), smallest = std::numeric_limits<double>::infinity();
  for (const double lambda : lambdas) {
    const double value = cross_validation(problem, lambda, rule == Regularization::srgcv);
    if (value < smallest) {
      smallest = value;
      best = lambda;
    }
  }
  return best;
}

}  // namespace fatmc
