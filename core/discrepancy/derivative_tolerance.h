// What errors of the model's aerodynamic derivatives, a few per cent each, could explain of what an explanation leaves.
//
// Nominal derivatives come from wind tunnels and handbooks and are taken to be known to kShare (one standard deviation of the
// logarithm of a factor). With D the white changes by one deviation of each derivative and J the explanation's own directions, which
// may give way, the residual r of the fit (orthogonal to J) is judged by the law that holds these errors too:
//
//   energy = min over x, t of |r - J x - D t|^2 + |t|^2 = |r|^2 - r^T D_J (I + D_J^T D_J)^-1 D_J^T r,   D_J orthogonal to J,
//
// all divided by W. The minimum's t are the derivatives' errors (posterior mean, covariance (I + D_J^T D_J)^-1), and the explanation's
// parameters move by -J^+ D t.
//
// That is for the question whether an explanation is adequate, alone: a derivative that is off is still found and named as any effect
// where it gains what an effect must.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "core/discrepancy/comparison.h"

namespace fatmc {

class DerivativeTolerance {
 public:
  static constexpr double kShare = 0.05;

  /// Derivatives among the candidates, those with an id in `excluded` left out.
  DerivativeTolerance(const Comparison& comparison, const std::vector<std::string>& excluded);

  struct Errors {
    std::vector<Effect> derivatives;  ///< at nominal values
    Eigen::VectorXd log_factor;       ///< most probable errors
    Eigen::MatrixXd covariance;       ///< of log_factor
    Eigen::VectorXd residual;         ///< W^-1 r without what they explain
    double energy = 0.0;
    Eigen::VectorXd shift;             ///< of the explanation's parameters, natural scale
    Eigen::MatrixXd shift_covariance;  ///< what the errors leave uncertain of them
  };
  /// `residual`, `jacobian`: divided by W, as is done by `deviation` here; derivatives in `effects` have no error beside.
  [[nodiscard]] Errors errors(const std::vector<Effect>& effects,
                              const Eigen::Ref<const Eigen::VectorXd>& residual,
                              const Eigen::Ref<const Eigen::MatrixXd>& jacobian,
                              const Eigen::Ref<const Eigen::VectorXd>& deviation) const;

 private:
  std::vector<Effect> derivatives_;
  Eigen::MatrixXd changes_;  ///< white, a column a derivative: by one standard deviation
};

}  // namespace fatmc
