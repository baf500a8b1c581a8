// Discrete Fourier transform of real signals: one convention for the whole project.
//
//   X(m) = N^(-1/2) sum_{n=0}^{N-1} x[n] exp(-j 2 pi m n / N)          (T section 2.2, scale 1/sqrt(N))
//
// With this scale white noise of variance s^2 has E|X(m)|^2 = s^2 at every bin, whatever N, and a line
// A cos(2 pi m n / N + phi) gives X(m) = sqrt(N) (A / 2) exp(j phi), 0 < m < N/2.
#pragma once

#include <complex>
#include <memory>
#include <span>

namespace fatmc {

/// Transform of one length. Objects of one length share a plan; any thread may use any object at any time.
///
/// FFTW plans are made with FFTW_ESTIMATE: FFTW_MEASURE chooses by timing, so that two runs of one program could
/// differ in the last bits.
class RealDft {
 public:
  /// `n` >= 2 samples.
  explicit RealDft(int n);

  [[nodiscard]] int size() const { return n_; }

  /// Bins 0 ... bins.size()-1 of `x`; x.size() == size(), bins.size() <= size()/2 + 1.
  /// Work for bins above the last one asked for is left out where the length is even.
  void transform(std::span<const double> x, std::span<std::complex<double>> bins) const;

  struct Plan;

 private:
  int n_;
  std::shared_ptr<const Plan> plan_;
};

/// Real signal of `x.size()` samples from its bins 0 ... x.size()/2 (missing ones are zero), the inverse of the
/// transform above.
void inverse_real_dft(std::span<const std::complex<double>> bins, std::span<double> x);

}  // namespace fatmc
