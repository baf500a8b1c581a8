// Maneuvers of vector-ARX systems with known parameters.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "core/random/random_stream.h"
#include "core/subspace/maneuvers.h"

namespace fatmc {

/// y_t = sum_l Xi_l z_{t-l} + sigma e_t, u = white (open loop) or r - gain y.
inline Maneuver vector_arx(const std::vector<Eigen::MatrixXd>& xi, Eigen::Index n_u, Eigen::Index samples,
                           double sigma, double feedback, std::uint64_t run) {
  RandomStream stream({7, 1, 2, run}, "vector-arx");
  const Eigen::Index n_y = xi.front().rows();
  Maneuver out{Eigen::MatrixXd::Zero(samples, n_u), Eigen::MatrixXd::Zero(samples, n_y)};
  for (Eigen::Index t = 0; t < samples; ++t) {
    for (std::size_t l = 1; l <= xi.size() && static_cast<Eigen::Index>(l) <= t; ++l) {
      const Eigen::Index past = t - static_cast<Eigen::Index>(l);
      Eigen::VectorXd z(n_u + n_y);
      z << out.inputs.row(past).transpose(), out.outputs.row(past).transpose();
      out.outputs.row(t) += (xi[l - 1] * z).transpose();
    }
    for (Eigen::Index i = 0; i < n_y; ++i) out.outputs(t, i) += sigma * stream.normal();
    for (Eigen::Index i = 0; i < n_u; ++i)
      out.inputs(t, i) = stream.normal() - feedback * out.outputs(t, i % n_y);
  }
  return out;
}

/// z^2 - 1.5 z + 0.7 under the output, one input.
inline std::vector<Eigen::MatrixXd> second_order() {
  return {(Eigen::MatrixXd(1, 2) << 1.0, 1.5).finished(), (Eigen::MatrixXd(1, 2) << 0.5, -0.7).finished()};
}

}  // namespace fatmc
