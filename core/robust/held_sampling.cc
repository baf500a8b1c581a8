#include "core/robust/held_sampling.h"

#include <unsupported/Eigen/MatrixFunctions>

namespace fatmc {

std::optional<SampledModel> sample_held(const SampledModel& continuous, double step_s) {
  const Eigen::Index n = continuous.a.rows(), inputs = continuous.b.cols();
  Eigen::MatrixXd block = Eigen::MatrixXd::Zero(n + inputs, n + inputs);
  block.topLeftCorner(n, n) = continuous.a * step_s;
  block.topRightCorner(n, inputs) = continuous.b * step_s;
  if (!block.allFinite()) return std::nullopt;
  const Eigen::MatrixXd exponential = block.exp();
  if (!exponential.allFinite()) return std::nullopt;
  return SampledModel{exponential.topLeftCorner(n, n), exponential.topRightCorner(n, inputs), continuous.c,
                      continuous.d};
}

}  // namespace fatmc
