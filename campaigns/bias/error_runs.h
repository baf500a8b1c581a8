// Error responses of a cell's runs and those of their mean: T averages the estimates of 50 runs, "so that excitation
// specific deviations from trim speed are compensated" (4.2.1), and states the error of that average.
#pragma once

#include <complex>
#include <span>
#include <vector>

#include "campaigns/base/line_runs.h"
#include "campaigns/base/study.h"
#include "campaigns/bias/row_arrays.h"

namespace fatmc::bias {

struct ErrorRuns {
  std::uint64_t trials = 0, failed = 0;
  std::vector<double> frequency_hz;
  std::array<std::vector<std::vector<std::complex<double>>>, kResponses.size()>
      ratio;  ///< response, run, line
  std::array<std::array<std::vector<double>, kReadings.size()>, kResponses.size()>
      relative_bias;  ///< a value a run

  [[nodiscard]] std::size_t runs() const { return trials - failed; }
  /// Index of the line nearest to a frequency.
  [[nodiscard]] std::size_t nearest_line(double hz) const { return fatmc::nearest_line(frequency_hz, hz); }
};

ErrorRuns error_runs(std::uint32_t cell, const RowSource& rows);

/// Error of the mean over the runs picked: 20 log10 |mean Ĝ/G0| in dB and its phase in degrees, (-180, 180].
struct MeanError {
  std::vector<double> magnitude_db, phase_deg;
};
MeanError mean_error(const ErrorRuns& runs, std::size_t response, std::span<const std::size_t> picks);

/// The same at one line.
std::complex<double> mean_ratio(const ErrorRuns& runs, std::size_t response, std::size_t line,
                                std::span<const std::size_t> picks);

double magnitude_error_db(std::complex<double> ratio);
double phase_error_deg(std::complex<double> ratio);

}  // namespace fatmc::bias
