// What a fast LPM estimate needs to know of the frequencies alone: windows, polynomial weights, degrees of freedom.
//
// Conventions (docs/notation.md; T sections 2.4 and 2.5):
// - The DFT runs over the whole record of P periods of N samples; line k (a harmonic of one period) is bin P k.
// - Transient and noise of a line come from the n nearest non-excited bins on each side, of the bins P k_1 - (P-1) ...
//   P k_F + (P-1); near those ends the window is shifted so that it keeps 2n bins (2.101, 2.107).
// - The FRM of a line comes from the 2 n_E + 1 nearest excited lines, n_E on each side by index; near the ends the
//   window is shifted.
// - The polynomial variable is the true distance in frequency, scaled by the window's largest distance: estimates do
//   not depend on the scale, the condition number does.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "core/base/error.h"
#include "core/ident/transient_windows.h"

namespace fatmc {

struct LpmOptions {
  int n_e = 9;          ///< excited lines on each side; q = 10 for three inputs and order 2
  int order = 2;        ///< R, degree of the local polynomials (of the FRM and of the transient)
  int n_transient = 5;  ///< non-excited bins on each side; q_noise = 7 for order 2
};

/// A periodic experiment as it was measured.
struct PeriodicExperiment {
  std::vector<int> lines;  ///< excited harmonics of one period, ascending, 0 < line < period_samples / 2
  int period_samples = 0;  ///< N
  int periods = 0;         ///< P >= 2
  double rate_hz = 0.0;
};

class LpmGrid {
 public:
  /// Fails, with the remedy, where lines, periods or options leave no degree of freedom for `n_in` inputs.
  static Result<LpmGrid> create(PeriodicExperiment experiment, LpmOptions options, int n_in);

  [[nodiscard]] const PeriodicExperiment& experiment() const { return experiment_; }
  [[nodiscard]] const LpmOptions& options() const { return options_; }
  [[nodiscard]] int line_count() const { return static_cast<int>(experiment_.lines.size()); }
  [[nodiscard]] int total_samples() const { return experiment_.periods * experiment_.period_samples; }
  [[nodiscard]] int n_in() const { return n_in_; }
  /// Excited lines in a window, 2 n_E + 1.
  [[nodiscard]] int window() const { return 2 * options_.n_e + 1; }
  /// Columns of the regression, (R + 1) n_in.
  [[nodiscard]] int parameters() const { return (options_.order + 1) * n_in_; }
  /// Complex degrees of freedom of the residuals, 2 n_E + 1 - (R + 1) n_in (2.147).
  [[nodiscard]] int q() const { return window() - parameters(); }
  /// 2 n - (R + 1) (2.113).
  [[nodiscard]] int q_noise() const { return 2 * options_.n_transient - (options_.order + 1); }
  [[nodiscard]] double frequency_hz(int k) const;
  /// DFT bin of line k.
  [[nodiscard]] int bin(int k) const { return experiment_.periods * experiment_.lines[static_cast<std::size_t>(k)]; }
  /// Bins 0 ... bin_count()-1 are all that an estimate reads.
  [[nodiscard]] int bin_count() const { return transient_.bin_count(); }

  /// Index of the first line of line k's window.
  [[nodiscard]] int first(int k) const { return first_[static_cast<std::size_t>(k)]; }
  /// The window is not symmetric about the line.
  [[nodiscard]] bool border(int k) const { return first(k) != k - options_.n_e; }
  /// Distances f_i - f_k of the window in Hz.
  [[nodiscard]] std::span<const double> offsets_hz(int k) const;
  /// The same divided by the largest of them in magnitude, in [-1, 1].
  [[nodiscard]] std::span<const double> scaled_offsets(int k) const;
  /// Largest distance of the window in Hz.
  [[nodiscard]] double scale_hz(int k) const { return scale_hz_[static_cast<std::size_t>(k)]; }

  /// The 2n non-excited bins of every line and the fits through them.
  [[nodiscard]] const TransientWindows& transient() const { return transient_; }

  /// Constant, linear (per Hz) and quadratic term (per Hz^2) of a polynomial of degree max(R, 2) through the window (appendix C.3).
  [[nodiscard]] std::span<const double> constant_row(int k) const;
  [[nodiscard]] std::span<const double> linear_row(int k) const;
  [[nodiscard]] std::span<const double> quadratic_row(int k) const;
  /// Constant term of degree R itself: what the LPM makes of a response without noise.
  [[nodiscard]] std::span<const double> own_constant_row(int k) const;
  /// |sum_i s_i d_i^E| in Hz^E, d_i the offsets and s the constant row of degree R; see interpolation_bias.h.
  [[nodiscard]] double bias_moment(int k) const { return bias_moment_[static_cast<std::size_t>(k)]; }
  /// E: R + 2 for even R, R + 1 for odd R.
  [[nodiscard]] int bias_exponent() const;

 private:
  LpmGrid() = default;
  void place_windows();
  void fit_bias_polynomials();

  PeriodicExperiment experiment_;
  LpmOptions options_;
  int n_in_ = 0;
  std::vector<int> first_;
  std::vector<double> offsets_hz_, scaled_offsets_, scale_hz_;
  TransientWindows transient_;
  std::vector<double> constant_rows_, own_constant_rows_, linear_rows_, quadratic_rows_, bias_moment_;
};

}  // namespace fatmc
