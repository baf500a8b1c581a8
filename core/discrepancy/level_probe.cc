#include "core/discrepancy/level_probe.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "core/base/text.h"
#include "core/discrepancy/effect_size.h"
#include "core/discrepancy/moment_filters.h"
#include "core/stats/intervals.h"

namespace fatmc {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

/// A direction of which less than this is left, in deviations, tells nothing: at its moderate size it hardly shows.
constexpr double kLeastLeft = 0.1;

struct Direction {
  Effect effect;
  int record = -1;
  Vector change;  ///< white
};

/// The smallest signature of every effect on the linear airframe.
Matrix linear_signatures(const Comparison& comparison) {
  const Dictionary& dictionary = comparison.dictionary();
  std::vector<int> smallest(dictionary.variants.size(), -1);
  for (std::size_t a = 0; a < dictionary.atoms.size(); ++a) {
    const Effect& effect = dictionary.atoms[a].effect;
    if (!effect.kind().in_linear_airframe || effect.values.size() != 1) continue;
    if (comparison.atoms().col(static_cast<Eigen::Index>(a)).isZero(0.0)) continue;
    int& own = smallest[static_cast<std::size_t>(dictionary.atoms[a].variant)];
    if (own < 0 ||
        relative_size(effect) < relative_size(dictionary.atoms[static_cast<std::size_t>(own)].effect))
      own = static_cast<int>(a);
  }
  std::erase(smallest, -1);
  return comparison.atoms()(Eigen::all, smallest);
}

std::vector<Direction> directions(const Comparison& comparison, const Explanation& e) {
  std::vector<Direction> out;
  for (Eigen::Index m = 0; m < comparison.moment_atoms().cols(); ++m) {
    const Effect& moment = higher_moments()[static_cast<std::size_t>(m)];
    const auto named = [&](const Effect& effect) { return effect.name() == moment.name(); };
    if (std::none_of(e.fit.effects.begin(), e.fit.effects.end(), named))
      out.push_back({moment, -1, comparison.moment_atoms().col(m)});
  }
  const std::vector<FreeParameter> free = free_parameters(e.fit.effects);
  for (std::size_t i = 1; i < comparison.records().size(); ++i) {
    const Eigen::Index first = comparison.first_row(i), rows = comparison.records()[i].basis->layout.size;
    for (std::size_t p = 0; p < free.size(); ++p) {
      if (static_cast<std::size_t>(free[p].effect) < e.nuisances) continue;
      const Effect& effect = e.fit.effects[static_cast<std::size_t>(free[p].effect)];
      const EffectParameter& kind = effect.kind().parameters[static_cast<std::size_t>(free[p].parameter)];
      Direction one{effect, static_cast<int>(i), Vector::Zero(comparison.size())};
      const double size = is_limit(kind) || !kind.strength ? 1.0 : least_moderate(kind);
      one.change.segment(first, rows) =
          size * e.fit.jacobian.col(static_cast<Eigen::Index>(p)).segment(first, rows);
      out.push_back(std::move(one));
    }
  }
  return out;
}

/// Orthonormal basis of the columns.
Matrix span_of(const Matrix& columns) {
  if (columns.cols() == 0) return columns;
  const Eigen::ColPivHouseholderQR<Matrix> qr(columns);
  return qr.householderQ() * Matrix::Identity(columns.rows(), static_cast<Eigen::Index>(qr.rank()));
}

}  // namespace

std::string LevelProbe::statement() const {
  const std::string how = " (" + significant(std::abs(score), 3) + " deviations, " + significant(limit, 3) +
                          " by chance at most)";
  if (record >= 0) {
    return "The value of " + effect.name() + " on record " + std::to_string(record + 1) +
           " is another than on the others: it depends on level, or on what else differs between them" + how +
           ".";
  }
  const std::string form =
      effect.id == "cubic_moment" ? "third power of the flow angle" : "square of the rate";
  return "A value depends on level: a moment in " + effect.choices.front().second + " with the " + form +
         " shows beside what a linear model explains" + how + ".";
}

LevelProbe probe_level(const Comparison& comparison, const Explanation& e, double alpha, double allowed) {
  LevelProbe out;
  const auto inverse = e.law.deviation().cwiseInverse().asDiagonal();
  const Matrix linear = linear_signatures(comparison);
  Matrix imitations(comparison.size(), linear.cols() + e.fit.jacobian.cols());
  imitations << linear, e.fit.jacobian;
  const Matrix within = span_of(inverse * imitations);
  const Vector r = e.weighted_residual();
  std::vector<Direction> all = directions(comparison, e);
  Matrix rows(0, comparison.size());
  std::vector<Direction> used;
  for (Direction& one : all) {
    Vector left = inverse * one.change;
    left -= within * (within.transpose() * left);
    if (!(left.norm() > kLeastLeft)) continue;
    rows.conservativeResize(rows.rows() + 1, Eigen::NoChange);
    rows.row(rows.rows() - 1) = left.transpose() / left.norm();
    used.push_back(std::move(one));
  }
  if (used.empty()) return out;
  const FittedLaw::Spread spread = e.law.spread(rows * inverse);
  const Vector scores = rows * r;
  const double share = alpha / (2.0 * static_cast<double>(used.size()));
  double most = 0.0;
  for (std::size_t i = 0; i < used.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    const double chance = t_quantile(1.0 - share, spread.dof[at]);
    const double limit = std::sqrt(chance * chance + allowed / (spread.deviation[at] * spread.deviation[at]));
    const double score = scores[at] / spread.deviation[at];
    if (i > 0 && std::abs(score) / limit <= most) continue;
    most = std::abs(score) / limit;
    out = {score, limit, used[i].effect, used[i].record};
  }
  return out;
}

}  // namespace fatmc
