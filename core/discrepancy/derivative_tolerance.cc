#include "core/discrepancy/derivative_tolerance.h"

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "core/discrepancy/effect_knowledge.h"
#include "core/discrepancy/effect_size.h"

namespace fatmc {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

DerivativeTolerance::DerivativeTolerance(const Comparison& comparison,
                                         const std::vector<std::string>& excluded) {
  const Dictionary& dictionary = comparison.dictionary();
  std::vector<Vector> changes;
  std::vector<double> sizes;
  std::vector<int> variants;
  for (std::size_t a = 0; a < dictionary.atoms.size(); ++a) {
    const Effect& effect = dictionary.atoms[a].effect;
    const Vector change = comparison.atoms().col(static_cast<Eigen::Index>(a));
    if (!is_derivative(effect.id) || change.isZero(0.0)) continue;
    if (std::find(excluded.begin(), excluded.end(), effect.id) != excluded.end()) continue;
    const EffectParameter& p = effect.kind().parameters.front();
    const double size = to_natural(p, effect.values.front()) - to_natural(p, p.nominal);
    const auto known = std::find(variants.begin(), variants.end(), dictionary.atoms[a].variant);
    const auto at = static_cast<std::size_t>(known - variants.begin());
    if (known == variants.end()) {
      variants.push_back(dictionary.atoms[a].variant);
      derivatives_.push_back(dictionary.variants[static_cast<std::size_t>(dictionary.atoms[a].variant)]);
      changes.push_back(change);
      sizes.push_back(size);
    } else if (std::abs(size) < std::abs(sizes[at])) {
      changes[at] = change;
      sizes[at] = size;
    }
  }
  changes_.resize(comparison.size(), static_cast<Eigen::Index>(changes.size()));
  for (std::size_t i = 0; i < changes.size(); ++i) {
    changes_.col(static_cast<Eigen::Index>(i)) = kShare / sizes[i] * changes[i];
  }
}

DerivativeTolerance::Errors DerivativeTolerance::errors(const std::vector<Effect>& effects,
                                                        const Eigen::Ref<const Vector>& residual,
                                                        const Eigen::Ref<const Matrix>& jacobian,
                                                        const Eigen::Ref<const Vector>& deviation) const {
  Errors out;
  std::vector<int> used;
  for (std::size_t i = 0; i < derivatives_.size(); ++i) {
    const bool own = std::any_of(effects.begin(), effects.end(),
                                 [&](const Effect& e) { return e.name() == derivatives_[i].name(); });
    if (own) continue;
    used.push_back(static_cast<int>(i));
    out.derivatives.push_back(derivatives_[i]);
  }
  const Matrix d = deviation.cwiseInverse().asDiagonal() * changes_(Eigen::all, used);
  const auto own = jacobian.completeOrthogonalDecomposition();
  const Matrix moved = jacobian.cols() > 0 ? Matrix(own.solve(d)) : Matrix(0, d.cols());  // J^+ D
  const Matrix left = jacobian.cols() > 0 ? Matrix(d - jacobian * moved) : d;
  const Matrix information = Matrix::Identity(d.cols(), d.cols()) + left.transpose() * left;
  const Matrix covariance = information.llt().solve(Matrix::Identity(d.cols(), d.cols()));
  const Vector t = covariance * (left.transpose() * residual);
  out.residual = residual - left * t;
  out.energy = out.residual.squaredNorm() + t.squaredNorm();
  out.log_factor = kShare * t;
  out.covariance = kShare * kShare * covariance;
  out.shift = -moved * t;
  out.shift_covariance = moved * covariance * moved.transpose();
  return out;
}

}  // namespace fatmc
