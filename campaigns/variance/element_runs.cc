#include "campaigns/variance/element_runs.h"

#include <cmath>
#include <complex>

namespace fatmc::variance {

double ElementRuns::between_runs(std::size_t line, std::size_t element,
                                 std::span<const std::size_t> picks) const {
  if (picks.size() < 2) return 0.0;
  const auto real = re.line(at(line, element)), imag = im.line(at(line, element));
  std::complex<double> mean;
  for (const std::size_t run : picks) mean += std::complex<double>(real[run], imag[run]);
  mean /= static_cast<double>(picks.size());
  double sum = 0.0;
  for (const std::size_t run : picks) sum += std::norm(std::complex<double>(real[run], imag[run]) - mean);
  return sum / static_cast<double>(picks.size() - 1);
}

ElementRuns element_runs(std::uint32_t cell, const RowSource& rows) {
  ElementRuns out;
  rows(cell, [&](const TrialRow& row) {
    ++out.trials;
    if (row.outcome != "ok") {
      ++out.failed;
      return;
    }
    if (out.frequency_hz.empty()) out.frequency_hz = array_of(row, kFrequency);
    out.re.add(array_of(row, kReal));
    out.im.add(array_of(row, kImag));
    out.variance.add(array_of(row, kVariance));
  });
  return out;
}

}  // namespace fatmc::variance
