// Random uncertain plants for tests and benchmarks of the structured singular value.
#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <cmath>
#include <complex>

#include "core/random/random_stream.h"

namespace fatmc::test {

struct UncertainLoop {
  Eigen::MatrixXcd x;     ///< n_in × n_out
  Eigen::MatrixXd radii;  ///< n_out × n_in
};

/// X complex normal, log-normal radii: nothing of an aircraft in it, all directions alike.
inline UncertainLoop random_loop(Eigen::Index n_in, Eigen::Index n_out, RandomStream& stream, double spread = 1.0) {
  UncertainLoop out{Eigen::MatrixXcd(n_in, n_out), Eigen::MatrixXd(n_out, n_in)};
  for (Eigen::Index j = 0; j < n_in; ++j) {
    for (Eigen::Index i = 0; i < n_out; ++i) {
      const double re = stream.normal();
      out.x(j, i) = {re, stream.normal()};
      out.radii(i, j) = std::exp(spread * stream.normal());
    }
  }
  return out;
}

/// X = (I + K G)⁻¹ K of a random plant with a dominant diagonal under a diagonal gain: a loop such as fatmc judges.
inline UncertainLoop random_feedback_loop(Eigen::Index n, RandomStream& stream) {
  UncertainLoop out = random_loop(n, n, stream, 0.5);
  Eigen::MatrixXcd plant = out.x;
  plant.diagonal() *= 3.0;
  const Eigen::MatrixXcd k = 0.5 * Eigen::MatrixXcd::Identity(n, n);
  out.x = (Eigen::MatrixXcd::Identity(n, n) + k * plant).lu().solve(k);
  return out;
}

}  // namespace fatmc::test
