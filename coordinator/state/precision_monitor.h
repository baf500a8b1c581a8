// When a cell is precise enough: evaluates a PrecisionRule on the trials 0 ... n-1 of each cell, for n one
// after another, whatever the order in which rows arrive. So N depends on the campaign alone, not on speed or
// number of workers.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "campaigns/base/precision_rule.h"

namespace fatmc {

struct CellPrecision {
  std::uint64_t trials = 0;  ///< n: all of 0 ... n-1 are known
  std::uint64_t values = 0;  ///< of these, those that count
  double mean = 0.0;
  Interval interval;
};

struct PrecisionReached {
  std::uint32_t cell = 0;
  CellPrecision at;  ///< at.trials is N
};

class PrecisionMonitor {
 public:
  PrecisionMonitor(PrecisionRule rule, std::size_t cells);

  /// A row that is stored, in any order, each once. Rows after a cell's end are ignored.
  void add(const TrialRow& row);
  /// Cells whose end was found and not yet acknowledged, in the order in which it was found.
  [[nodiscard]] const std::vector<PrecisionReached>& reached() const { return reached_; }
  /// The first of them has been acted upon.
  void acknowledge() { reached_.erase(reached_.begin()); }

  [[nodiscard]] const PrecisionRule& rule() const { return rule_; }
  [[nodiscard]] CellPrecision now(std::uint32_t cell) const;
  /// Why the rule can say nothing any more of some cell (a value beyond the bounds); empty while it can.
  [[nodiscard]] const std::string& failure() const { return failure_; }

 private:
  struct CellState {
    ConfidenceSequence sequence;
    std::uint64_t trials = 0;
    std::map<std::uint64_t, std::optional<double>> waiting;  // for those before them
    bool ended = false;
  };
  void advance(std::uint32_t cell);

  PrecisionRule rule_;
  std::vector<CellState> cells_;
  std::vector<PrecisionReached> reached_;
  std::string failure_;
};

}  // namespace fatmc
