// A record of a rate loop as the comparison reads it, measured or simulated.
#pragma once

#include <Eigen/Core>

namespace fatmc {

/// One row a sample. Channels that a record does not have are matrices of no columns.
struct LoopRecord {
  Eigen::MatrixX3d reference;  ///< r, rad/s; open loop: the commands themselves
  Eigen::MatrixX3d input;      ///< u, normalised commands
  Eigen::MatrixX3d output;     ///< y = p, q, r, rad/s
  Eigen::MatrixXd attitude;    ///< phi, theta, rad; samples x 2 or x 0
  Eigen::MatrixXd airspeed;    ///< V, m/s; samples x 1 or x 0

  [[nodiscard]] bool has_attitude() const { return attitude.cols() == 2; }
  [[nodiscard]] bool has_airspeed() const { return airspeed.cols() == 1; }
};

}  // namespace fatmc
