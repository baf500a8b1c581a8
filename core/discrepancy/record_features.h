// The features of feature_layout.h, taken from a record.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>
#include <vector>

#include "core/discrepancy/feature_layout.h"
#include "core/discrepancy/loop_record.h"
#include "core/discrepancy/moment_filters.h"
#include "core/ident/transient_windows.h"
#include "core/signal/dft.h"

namespace fatmc {

/// x without the straight line from its first to its last sample, its mean kept. A record that ends elsewhere than it began has
/// a step where the DFT closes it, whose power falls with f^-2 only and would hide the gyros' noise.
void level_ends(std::span<const double> x, std::vector<double>& out);

/// Const after construction, may be shared by threads.
class FeatureExtractor {
 public:
  /// `gain`: stated diagonal of K, s/rad; read where layout.controller is set.
  FeatureExtractor(FeatureLayout layout, const Eigen::Vector3d& gain);

  /// The same, with the outputs of the filters as further features.
  [[nodiscard]] FeatureExtractor with(std::shared_ptr<const MomentFilters> filters) const;

  [[nodiscard]] const FeatureLayout& layout() const { return layout_; }
  /// layout().size features of a record of the experiment's length that has the layout's channels.
  [[nodiscard]] Eigen::VectorXd extract(const LoopRecord& record) const;

 private:
  void spectra(const LoopRecord& record, Eigen::VectorXd& out) const;
  void controller(const LoopRecord& record, double* out) const;

  FeatureLayout layout_;
  Eigen::Vector3d gain_;
  RealDft dft_;
  TransientWindows windows_;
  std::vector<std::uint8_t> excited_;  ///< by harmonic
  std::shared_ptr<const MomentFilters> filters_;
};

}  // namespace fatmc
