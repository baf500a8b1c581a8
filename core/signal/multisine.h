// Random-phase multisines on any set of harmonic lines (T 3.2.5).
//
//   r[n] = sum_k A_k cos(2 pi k n / N + phi_k),   phi_k independent and uniform on [0, 2 pi)
//
// k counts harmonics of one period of N samples; frequency_hz = k rate_hz / N.
#pragma once

#include <complex>
#include <span>
#include <vector>

#include "core/base/error.h"
#include "core/random/random_stream.h"

namespace fatmc {

/// Frequencies start, start + step, ... up to stop (included).
struct FrequencyRange {
  double start_hz = 0.0;
  double stop_hz = 0.0;
  double step_hz = 0.0;
};

/// Harmonics of `base_hz` that lie in the ranges, ascending, each once (ranges may share an end).
/// Fails where a start, stop or step is no multiple of base_hz, or where a range is empty.
Result<std::vector<int>> lines_from_ranges(std::span<const FrequencyRange> ranges, double base_hz);

/// Lines of one of several inputs that share `lines` without overlap (zippered): input, input + inputs, input + 2 inputs ...
std::vector<int> zippered_lines(std::span<const int> lines, int input, int inputs);

/// The ranges of T Table 5-1 (base 0.005 Hz, 73 lines, harmonics 57 ... 578). Printed is a last step of 0.7 Hz;
/// 0.07 Hz gives the 73 lines of the text.
std::span<const FrequencyRange> table_5_1_ranges();

class Multisine {
 public:
  /// One amplitude (peak, not rms) and one phase in rad a line; 0 < line < period_samples / 2.
  Multisine(int period_samples, std::vector<int> lines, std::vector<double> amplitudes, std::vector<double> phases);

  /// Phases from `stream`, in the order of the lines.
  static Multisine random_phase(int period_samples, std::vector<int> lines, std::vector<double> amplitudes,
                                RandomStream& stream);
  static Multisine random_phase(int period_samples, std::vector<int> lines, double amplitude, RandomStream& stream);

  [[nodiscard]] int period_samples() const { return period_samples_; }
  [[nodiscard]] const std::vector<int>& lines() const { return lines_; }
  [[nodiscard]] const std::vector<double>& amplitudes() const { return amplitudes_; }
  [[nodiscard]] const std::vector<double>& phases() const { return phases_; }

  /// One period.
  [[nodiscard]] std::vector<double> period() const;
  /// `periods` periods, one after the other.
  [[nodiscard]] std::vector<double> samples(int periods) const;
  /// What RealDft gives for `periods` periods at the bins periods * line: sqrt(periods N) (A / 2) exp(j phi).
  [[nodiscard]] std::vector<std::complex<double>> spectrum(int periods) const;
  /// Root mean square of the samples, from the amplitudes: sqrt(sum A^2 / 2).
  [[nodiscard]] double rms() const;

 private:
  int period_samples_;
  std::vector<int> lines_;
  std::vector<double> amplitudes_;
  std::vector<double> phases_;
};

/// sqrt(mean x^2)
double rms(std::span<const double> x);

/// max |x| / rms(x); 0 for a signal that is zero.
double crest_factor(std::span<const double> x);

}  // namespace fatmc
