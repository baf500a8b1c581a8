// Input signal-to-noise ratio over lines and runs (T section 5.2.3, Fig. 5-3).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "campaigns/base/published_figures.h"
#include "campaigns/base/study.h"

namespace fatmc::coverage {

class SnrSummary {
 public:
  /// One run: SNR in dB, line by line, inside a line input by input.
  void add(const std::vector<double>& snr_db, std::size_t inputs);

  /// Rows of table "Section 5.2.3": smallest value, smallest and largest median over the lines, share of runs
  /// below 20 dB.
  void add_rows(std::uint64_t trials, const std::string& suffix,
                const std::vector<PublishedFigure>& published, std::vector<TableRow>& out) const;

 private:
  std::size_t inputs_ = 0;
  std::vector<std::vector<double>> runs_;
};

}  // namespace fatmc::coverage
