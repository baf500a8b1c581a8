// What a pass over the rows of one cell collects: estimates and estimated variances by element of a line and run.
#pragma once

#include <span>
#include <vector>

#include "campaigns/base/line_runs.h"
#include "campaigns/base/study.h"
#include "campaigns/variance/row_arrays.h"

namespace fatmc::variance {

struct ElementRuns {
  std::uint64_t trials = 0, failed = 0;
  std::vector<double> frequency_hz;
  LineRuns re, im, variance;  ///< "line" is kElements * line + element

  [[nodiscard]] std::size_t runs() const { return trials - failed; }
  static std::size_t at(std::size_t line, std::size_t element) { return line * kElements + element; }
  /// Complex sample variance of Ĝ over the runs picked, sum |Ĝ - mean|^2/(n - 1) (T 4.4); picks of one run give zero.
  [[nodiscard]] double between_runs(std::size_t line, std::size_t element,
                                    std::span<const std::size_t> picks) const;
  /// Index of the line nearest to a frequency.
  [[nodiscard]] std::size_t nearest_line(double hz) const { return fatmc::nearest_line(frequency_hz, hz); }
};

ElementRuns element_runs(std::uint32_t cell, const RowSource& rows);

}  // namespace fatmc::variance
