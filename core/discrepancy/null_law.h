// The law of a record's features where the model is right: N(mean, L (I + F F^T) L^T).
//
// L is block-diagonal, a Cholesky factor for each FeatureBlock. A line's features are parts of complex normal variables
// that are proper (a stationary process has no preferred phase), so that their covariance C is estimated as
// a complex one and [Re; Im] has 1/2 [Re C, -Im C; Im C, Re C]. What correlation across blocks is left is of low rank.
//
// Variances have floors, for what no simulation of the model shows:
//   attitude     is trusted to kAttitudeTrust of its response at a line: without it, p and d(phi)/dt would agree to the
//                gyro's noise alone, 60 dB below the response, and any change of the noise would look like a wrong model
//   controller   gains that logged commands show, to kGainTrust, offsets to kOffsetTrust of full command;
//                lattice: kLatticeTrust
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/discrepancy/feature_layout.h"
#include "core/discrepancy/low_rank_covariance.h"

namespace fatmc {

struct NullLaw {
  static constexpr double kAttitudeTrust = 0.01, kGainTrust = 2e-3, kOffsetTrust = 5e-4, kLatticeTrust = 0.02;
  static constexpr int kMostDirections = 16;

  Eigen::VectorXd mean;
  std::vector<Eigen::MatrixXd> inverse_factor;  ///< L^-1 of every block, lower triangular
  LowRankCovariance covariance;                 ///< of L^-1 (x - mean)

  /// From `samples`, N x layout.size, simulations of the model; N > 2 times the channels.
  static NullLaw fit(const FeatureLayout& layout, const Eigen::Ref<const Eigen::MatrixXd>& samples);

  /// (I + F F^T)^(-1/2) L^-1 D, columns of differences of features: where the model is right, columns of x - mean become
  /// white noise of unit variance.
  [[nodiscard]] Eigen::MatrixXd whiten(const FeatureLayout& layout,
                                       const Eigen::Ref<const Eigen::MatrixXd>& d) const;
  /// Adds what is not known of the experiment: columns of D are changes of the features by one standard deviation each.
  void add_uncertainty(const FeatureLayout& layout, const Eigen::Ref<const Eigen::MatrixXd>& d);

 private:
  [[nodiscard]] Eigen::MatrixXd whiten_blocks(const FeatureLayout& layout,
                                              const Eigen::Ref<const Eigen::MatrixXd>& d) const;
};

}  // namespace fatmc
