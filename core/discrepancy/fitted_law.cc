#include "core/discrepancy/fitted_law.h"

#include <algorithm>
#include <cmath>

#include "core/base/check.h"

namespace fatmc {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

constexpr double kLeastVariance = 0.02;                 // below, a group is its floor
constexpr double kLeastScale = 0.05, kMostScale = 1e4;  // of W^2
constexpr double kRounding = 1e-8;                      // of the variance of white noise

Matrix centred(const Matrix& x) { return x.colwise() - x.rowwise().mean(); }

double mean_square(const Matrix& x, const std::vector<int>& rows, double divisor) {
  return x(rows, Eigen::all).squaredNorm() / (divisor * static_cast<double>(rows.size()));
}

/// Rows of a group that share a deviation. Those of lines stand in pairs of real and imaginary part, which are not alike: the
/// attitude's real part, whose floor is its own, tells most of what the rate's imaginary part can be.
std::vector<std::vector<int>> parts_of(const FeatureGroup& group) {
  if (group.kind != FeatureKind::line) return {group.rows};
  std::vector<std::vector<int>> out(2);
  for (std::size_t i = 0; i < group.rows.size(); ++i) out[i % 2].push_back(group.rows[i]);
  return out;
}

}  // namespace

FittedLaw::FittedLaw(const Comparison& comparison)
    : comparison_(&comparison),
      change_(Vector::Zero(comparison.size())),
      deviation_(Vector::Ones(comparison.size())),
      group_excess_(Vector::Zero(comparison.group_count())) {}

std::optional<FittedLaw> FittedLaw::of(const Comparison& comparison, const std::vector<Effect>& effects,
                                       int flights) {
  FittedLaw out(comparison);
  const std::vector<std::vector<Effect>> sets = {effects};
  std::vector<EffectFlights> flown;
  std::vector<int> completed;  // on every record
  for (std::size_t i = 0; i < comparison.records().size(); ++i) {
    flown.push_back(comparison.records()[i]
                        .model->fly(sets, comparison.first_flight(i, flights), flights, comparison.threads())
                        .front());
    std::vector<int> both;
    for (const int n : flown.back().completed) {
      if (i == 0 || std::find(completed.begin(), completed.end(), n) != completed.end()) both.push_back(n);
    }
    completed = std::move(both);
  }
  if (4 * completed.size() < 3 * static_cast<std::size_t>(flights)) return std::nullopt;
  const auto count = static_cast<Eigen::Index>(completed.size());
  out.with_.resize(comparison.size(), count);
  out.without_.resize(comparison.size(), count);
  for (std::size_t i = 0; i < flown.size(); ++i) {
    const ComparisonBasis& basis = *comparison.records()[i].basis;
    std::vector<int> numbers = completed;
    for (int& n : numbers) n += comparison.first_flight(i, flights);
    const Eigen::Index first = comparison.first_row(i), rows = basis.layout.size;
    const Matrix with =
        basis.law.whiten(basis.layout, flown[i].features(Eigen::all, completed).colwise() - basis.law.mean);
    const Matrix without = basis.white_baseline(Eigen::all, numbers);
    out.change_.segment(first, rows) = (with - without).rowwise().mean();
    out.with_.middleRows(first, rows) = centred(with);
    out.without_.middleRows(first, rows) = centred(without);
    out.measure_noise(i, out.with_.middleRows(first, rows), out.without_.middleRows(first, rows));
  }
  out.measure_scan();
  return out;
}

void FittedLaw::measure_noise(std::size_t record, const Matrix& with, const Matrix& without) {
  const ComparisonBasis& basis = *comparison_->records()[record].basis;
  const auto flights = static_cast<double>(with.cols());
  const Eigen::Index first = comparison_->first_row(record), group = comparison_->first_group(record);
  const Matrix difference = with - without;
  for (std::size_t g = 0; g < basis.groups.size(); ++g) {
    for (const std::vector<int>& rows : parts_of(basis.groups[g])) {
      const double a = mean_square(with, rows, flights - 1.0), b = mean_square(without, rows, flights - 1.0);
      const double shown = std::min(
          1.0, mean_square(basis.white_baseline, rows, static_cast<double>(basis.white_baseline.cols())));
      const double scale =
          std::clamp(b > kLeastVariance && shown > kLeastVariance ? 1.0 - shown + shown * a / b : 1.0 + a - b,
                     kLeastScale, kMostScale);
      for (const int row : rows) deviation_[first + row] = std::sqrt(scale);
      group_excess_[group + static_cast<Eigen::Index>(g)] +=
          difference(rows, Eigen::all).squaredNorm() / ((flights - 1.0) * flights * scale);
    }
  }
}

void FittedLaw::measure_scan() {
  const Matrix atoms = deviation_.cwiseInverse().asDiagonal() * comparison_->atoms();
  const auto largest = [](const Matrix& a, const Matrix& z) {
    const Matrix products = a.transpose() * z;
    const Vector norm = a.colwise().norm().transpose();
    double sum = 0.0;
    for (Eigen::Index n = 0; n < z.cols(); ++n) {
      double most = 0.0;
      for (Eigen::Index j = 0; j < a.cols(); ++j) {
        if (norm[j] > 0.0) most = std::max(most, products(j, n) / norm[j]);
      }
      sum += most * most;
    }
    return sum;
  };
  const double without = largest(comparison_->atoms(), without_);
  const double with = largest(atoms, deviation_.cwiseInverse().asDiagonal() * with_);
  if (without > 0.0) scan_ratio_ = std::max(1.0, with / without);
}

FittedLaw::Spread FittedLaw::spread(const Eigen::Ref<const Matrix>& a) const {
  const Matrix all = centred(a * comparison_->white_baseline());
  const auto many = static_cast<double>(all.cols());
  Spread out{Vector(a.rows()), Vector::Constant(a.rows(), many - 1.0)};
  if (with_.cols() == 0) {  // the model as it is
    out.deviation =
        (all.rowwise().squaredNorm() / (many - 1.0)).cwiseMax(a.rowwise().squaredNorm()).cwiseSqrt();
    return out;
  }
  FATMC_CHECK(with_.cols() > 3, "flights with the effects");
  const Matrix with = a * with_, without = a * without_;
  const auto flights = static_cast<double>(with_.cols());
  for (Eigen::Index i = 0; i < a.rows(); ++i) {
    const double bb = without.row(i).squaredNorm(), length = a.row(i).squaredNorm();
    // Where flights show nothing but rounding, floors stand for everything and the effects leave them.
    const double beta = bb > kRounding * length * flights ? with.row(i).dot(without.row(i)) / bb : 1.0;
    const double left = (with.row(i) - beta * without.row(i)).squaredNorm() / (flights - 2.0);
    const double known = std::max(all.row(i).squaredNorm() / (many - 1.0), length);
    const double mean = (with.row(i) - without.row(i)).squaredNorm() / ((flights - 1.0) * flights);
    const double regressed = beta * beta * known, sum = regressed + left + mean;
    out.deviation[i] = std::sqrt(sum);
    // Welch & Satterthwaite.
    out.dof[i] =
        sum * sum / (regressed * regressed / (many - 1.0) + (left * left + mean * mean) / (flights - 2.0));
  }
  return out;
}

}  // namespace fatmc
