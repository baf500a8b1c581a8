// Where record and model disagree: a map over elements of the frequency response matrix and bands.
//
// A cell is an element in a band of lines. Its statistic is the mean of |G - G_0|^2/v over the band's lines, G_0 and v mean
// and variance of estimates from flights of the model on the same reference. Its own mean and deviation over those flights
// carry the correlation between lines, and the largest over all cells of a flight gives the threshold that holds for the
// whole map at once.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "core/discrepancy/loop_record.h"
#include "core/ident/fast_lpm.h"

namespace fatmc {

struct MapCell {
  int output = 0, input = 0;
  int first = 0, last = 0;  ///< lines, both included
};

struct MapEntry {
  MapCell cell;
  double low_hz = 0.0, high_hz = 0.0;
  double decibel = 0.0;  ///< power of the response over that of the model's
  double degrees = 0.0;  ///< phase of the response against the model's, mean over the band weighted by power
  double sigma = 0.0;    ///< rms of |G - G_0| over the band, in standard deviations of an estimate
  double limit = 0.0;    ///< what sigma exceeds anywhere on the map in 1 % of the model's flights
  [[nodiscard]] bool significant() const { return sigma > limit; }
};

class ResponseMap {
 public:
  static constexpr int kBands = 6;

  /// Cells alone, without a law.
  static ResponseMap layout_of(const LpmGrid& grid);
  /// `responses`: flights x elements (line-major, then column by column), the estimates from the model's flights.
  static ResponseMap fit(const LpmGrid& grid, const Eigen::Ref<const Eigen::MatrixXcd>& responses);

  [[nodiscard]] const std::vector<MapCell>& cells() const { return cells_; }
  /// All cells, in their order.
  [[nodiscard]] std::vector<MapEntry> read(const Eigen::Ref<const Eigen::VectorXcd>& response) const;
  [[nodiscard]] const Eigen::VectorXcd& mean() const { return mean_; }
  [[nodiscard]] const Eigen::VectorXd& variance() const { return variance_; }

 private:
  friend struct BasisFile;
  [[nodiscard]] Eigen::VectorXd statistics(const Eigen::Ref<const Eigen::VectorXcd>& response) const;

  std::vector<double> frequency_hz_;
  std::vector<MapCell> cells_;
  Eigen::VectorXcd mean_;
  Eigen::VectorXd variance_, centre_, deviation_;
  double threshold_ = 0.0;
};

/// The estimate of a record in the order of ResponseMap::fit; lines without an estimate hold zeros.
Eigen::VectorXcd response_vector(FastLpm& estimator, const LoopRecord& record, bool closed_loop);

}  // namespace fatmc
