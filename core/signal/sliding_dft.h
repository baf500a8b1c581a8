// DFT of a window that moves over a stream, at chosen bins.
//
//   X(k) = N^(-1/2) sum_{m=0}^{N-1} x[n0 + m] exp(-j 2 pi k m / N),   n0 the window's oldest sample
//
// Every sample changes the sums S(k) = sum_n x[n] exp(-j 2 pi k n / N) by (x[n] - x[n - N]) exp(-j 2 pi k n /
// N), whose phase is looked up at k n mod N: nothing is multiplied again and again, so that rounding adds up
// like a random walk and not like a recursion with a pole on the unit circle. Once a window's length of
// samples the sums are computed afresh by an FFT, which bounds the drift (tests: 1e-13 of the spectrum's
// largest value). X(k) = N^(-1/2) exp(j 2 pi k n0 / N) S(k): seen from the window's beginning, as the
// transient's smoothness over frequency demands.
#pragma once

#include <Eigen/Core>
#include <complex>
#include <cstdint>
#include <span>
#include <vector>

#include "core/signal/dft.h"

namespace fatmc {

class SlidingDft {
 public:
  /// `bins`: 0 <= bin <= window_samples / 2, ascending. Until the window is full its beginning is zeros.
  SlidingDft(int window_samples, std::vector<int> bins, int channels);

  /// One sample of every channel.
  void push(std::span<const double> sample);
  /// Samples pushed so far.
  [[nodiscard]] std::int64_t count() const { return count_; }
  [[nodiscard]] bool full() const { return count_ >= window_samples_; }
  [[nodiscard]] const std::vector<int>& bins() const { return bins_; }

  /// Row k of `out` (bins x channels) is bin bins()[k], in the scale of RealDft over the window.
  void spectrum(Eigen::Ref<Eigen::MatrixXcd> out) const;
  /// Row bins()[k] of `out` instead; other rows stay.
  void spectrum_at_bins(Eigen::Ref<Eigen::MatrixXcd> out) const;

 private:
  void refresh();
  [[nodiscard]] std::complex<double> turn(std::size_t k) const;

  int window_samples_, channels_;
  std::vector<int> bins_;
  std::vector<int> step_;                      ///< k n mod N of each bin
  std::vector<std::complex<double>> twiddle_;  ///< exp(-j 2 pi i / N)
  std::vector<double> window_;                 ///< ring, channel by channel
  Eigen::ArrayXXd sum_re_, sum_im_;            ///< bins x channels
  Eigen::ArrayXd turn_re_, turn_im_;           ///< exp(-j 2 pi k n / N) of the sample at hand
  Eigen::VectorXd change_;
  std::int64_t count_ = 0;
  RealDft dft_;
};

}  // namespace fatmc
