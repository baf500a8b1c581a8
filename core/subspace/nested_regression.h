// The regression on the past of predictor_regression.h for one past window after the other, longest first.
//
// With lags most recent first the regressors of p - d are the leading columns of those of p, and its samples
// are those of p and the d first ones that the longer past had to leave out, in each maneuver. So the factor
// of p - d is the leading block of that of p with d J rows appended: 2 (p n_z)^2 d J operations, nothing is
// taken away from a factor (which would cost digits), and the result is the exact window of p - d to
// rounding. The same holds for the factor of [Phi; lambda I], so that a fixed lambda costs no factorisation a
// window.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

#include "core/base/error.h"
#include "core/subspace/maneuvers.h"
#include "core/subspace/ridge_choice.h"

namespace fatmc {

class NestedRegression {
 public:
  /// Factors the regression of `past`; fails as factor_predictor does. `maneuvers` must outlive this.
  static Result<NestedRegression> make(std::span<const Maneuver> maneuvers, int past);

  /// Goes on to a shorter past window, at least 1.
  void shorten(int past);

  struct Solution {
    Eigen::MatrixXd xi;  ///< n_y x p n_z, [Xi_1 ... Xi_p], most recent first
    double lambda = 0.0;
  };
  /// As solve_predictor. A fixed lambda is kept from window to window; another one, or a rule, factors anew.
  Result<Solution> solve(const RegularizationOptions& options);

  [[nodiscard]] int past() const { return past_; }
  [[nodiscard]] int n_u() const { return n_u_; }
  [[nodiscard]] int n_y() const { return n_y_; }
  [[nodiscard]] int n_z() const { return n_u_ + n_y_; }
  [[nodiscard]] Eigen::Index unknowns() const { return static_cast<Eigen::Index>(past_) * n_z(); }
  /// M = sum (N_j - p).
  [[nodiscard]] Eigen::Index equations() const;
  /// [Phi^T Z^T] = Q [R B; 0 *], Z = [U; Y] of the same samples: upper triangular, p n_z x p n_z; not set
  /// below.
  [[nodiscard]] auto r() const { return plain_.r.topLeftCorner(unknowns(), unknowns()); }
  /// p n_z x n_z.
  [[nodiscard]] auto b() const { return plain_.b.topRows(unknowns()); }

 private:
  /// In the storage of the longest window; leading blocks are in use.
  struct Triangle {
    Eigen::MatrixXd r, b;
  };

  NestedRegression(std::span<const Maneuver> maneuvers, int past);
  void append(Triangle& triangle, const Eigen::MatrixXd& rows, const Eigen::MatrixXd& rhs, bool residual);
  Result<double> chosen(Regularization rule);
  void factor_ridge(double lambda);

  std::span<const Maneuver> maneuvers_;
  int past_ = 0, n_u_ = 0, n_y_ = 0;
  Triangle plain_;
  Eigen::VectorXd residual_;  ///< n_y, squares that no Xi explains
  Triangle ridge_;            ///< of [Phi; lambda I]; empty until needed
  std::optional<double> ridge_lambda_;
};

}  // namespace fatmc
