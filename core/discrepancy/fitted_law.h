// What chance does to a record of the model with effects: the effects change the noise, too.
//
// From a few flights with the effects, set against flights of the model with the same noise (common random numbers), whose law
// is known from many. For a group of features (comparison_basis.h; of lines, real and imaginary parts apart) let v_a and v_b be the variances, in white coordinates, of
// flights with and without, and f the variance of all flights without that are kept: 1 but where a floor stands for what no
// flight shows. Then the deviation of the group with the effects is W,
//   W^2 = 1 - f + f v_a/v_b   (v_b > 0.02, else 1 + v_a - v_b),
// and r/W is white as z is where the model is right, but for correlations that the effects bring. Intervals carry those as well:
// of an estimate A r, the variance is that of A x over flights with the effects, by regression on the flights without (double
// sampling, Cochran 1977, 12.6): with a = A x_a, b = A x_b,
//   Var = beta^2 max(Var_all(b), A A^T) + s^2_(a|b) + s^2_(a-b)/L,   beta = cov(a, b)/var(b) over the L pairs,
// the last term the error of the mean change over L flights; A A^T is what the law of the model gives, whose floors no flight
// shows.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "core/discrepancy/comparison.h"

namespace fatmc {

class FittedLaw {
 public:
  static constexpr int kFlights = 16;

  /// Of the model as it is: W = 1.
  explicit FittedLaw(const Comparison& comparison);
  /// None where less than three quarters of the flights have a result.
  static std::optional<FittedLaw> of(const Comparison& comparison, const std::vector<Effect>& effects,
                                     int flights);

  /// Mean change of the features by the effects, white.
  [[nodiscard]] const Eigen::VectorXd& change() const { return change_; }
  /// W, a feature each.
  [[nodiscard]] const Eigen::VectorXd& deviation() const { return deviation_; }
  /// What the error of the mean change adds to |r/W|^2 in the mean, and to every group's part of it.
  [[nodiscard]] double excess() const { return group_excess_.sum(); }
  [[nodiscard]] const Eigen::VectorXd& group_excess() const { return group_excess_; }
  /// How much larger the largest signature GLR of a flight with the effects is in the mean, both in their own coordinates;
  /// not below 1.
  [[nodiscard]] double scan_ratio() const { return scan_ratio_; }
  /// Standard deviation of every row of A r, r the residual of a record by change(), and degrees of freedom behind it. For the model
  /// as it is: that over its kept flights, not below the law's.
  struct Spread {
    Eigen::VectorXd deviation, dof;
  };
  [[nodiscard]] Spread spread(const Eigen::Ref<const Eigen::MatrixXd>& a) const;

 private:
  void measure_noise(std::size_t record, const Eigen::MatrixXd& with, const Eigen::MatrixXd& without);
  void measure_scan();

  const Comparison* comparison_;
  Eigen::VectorXd change_, deviation_, group_excess_;
  double scan_ratio_ = 1.0;
  Eigen::MatrixXd with_,
      without_;  ///< features over flights, white and centred; empty for the model as it is
};

}  // namespace fatmc
