#include "core/handling/control_loop.h"

#include <Eigen/LU>

#include "core/base/check.h"

namespace fatmc {

ContinuousModel with_feedback(const ContinuousModel& model, const Eigen::Ref<const Eigen::MatrixXd>& gain) {
  FATMC_CHECK(gain.rows() == model.b.cols() && gain.cols() == model.c.rows(), "with_feedback: gain");
  // y = C x + D u, u = r - K y:  u = (I + K D)^-1 (r - K C x).
  const Eigen::Index n_u = model.b.cols();
  const Eigen::MatrixXd loop = Eigen::MatrixXd::Identity(n_u, n_u) + gain * model.d;
  const Eigen::PartialPivLU<Eigen::MatrixXd> lu(loop);
  const Eigen::MatrixXd from_reference = lu.inverse(), from_state = -from_reference * gain * model.c;
  return {model.a + model.b * from_state, model.b * from_reference, model.c + model.d * from_state,
          model.d * from_reference};
}

ContinuousModel with_input_filter(const ContinuousModel& model, Eigen::Index input,
                                  const InputFilter& filter) {
  FATMC_CHECK(input >= 0 && input < model.b.cols(), "with_input_filter: input");
  const Eigen::Index n = model.a.rows();
  const double w = filter.frequency_rad_s, two_d_w = 2.0 * filter.damping * w;
  // z'' + 2 D w z' + w^2 z = v;  b2 s^2 + b1 s = b2 (denominator) + (b1 - 2 D w b2) s - b2 w^2.
  const double direct = 1.0 + filter.gain * filter.b2, from_z = -filter.gain * filter.b2 * w * w,
               from_rate = filter.gain * (filter.b1 - two_d_w * filter.b2);
  ContinuousModel out;
  out.a = Eigen::MatrixXd::Zero(n + 2, n + 2);
  out.a.topLeftCorner(n, n) = model.a;
  out.a.col(n).head(n) = from_z * model.b.col(input);
  out.a.col(n + 1).head(n) = from_rate * model.b.col(input);
  out.a.bottomRightCorner(2, 2) << 0.0, 1.0, -w * w, -two_d_w;
  out.b = Eigen::MatrixXd::Zero(n + 2, model.b.cols());
  out.b.topRows(n) = model.b;
  out.b.col(input).head(n) *= direct;
  out.b(n + 1, input) = 1.0;
  out.c = Eigen::MatrixXd::Zero(model.c.rows(), n + 2);
  out.c.leftCols(n) = model.c;
  out.c.col(n) = from_z * model.d.col(input);
  out.c.col(n + 1) = from_rate * model.d.col(input);
  out.d = model.d;
  out.d.col(input) *= direct;
  return out;
}

Eigen::MatrixXd act_fhs_gain() {
  Eigen::MatrixXd gain = Eigen::MatrixXd::Zero(4, 8);
  constexpr Eigen::Index p = 3, q = 4, r = 5, phi = 6, theta = 7;
  gain(0, q) = 50.0;
  gain(0, theta) = 60.0;
  gain(1, p) = 60.0;
  gain(1, phi) = 50.0;
  gain(2, r) = 50.0;
  return gain;
}

InputFilter act_fhs_filter() { return {0.9, 0.4, -6.0, 0.6, 12.6}; }

ContinuousModel stabilized_vehicle(const ContinuousModel& bare) {
  return with_feedback(bare, act_fhs_gain());
}

ContinuousModel optimized_vehicle(const ContinuousModel& bare) {
  return with_feedback(with_input_filter(bare, kLateralInput, act_fhs_filter()), act_fhs_gain());
}

}  // namespace fatmc
