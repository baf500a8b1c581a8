// The rows of a cell, counted: what tables and figures are made of.
//
// Trials without an answer (the aircraft left its model) are outcomes like others: they stand in every denominator, where they
// count as not detected, not named, not right.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "campaigns/base/study.h"
#include "campaigns/hidden_effect/hidden_tier.h"

namespace fatmc::hidden_effect {

struct Count {
  std::uint64_t hits = 0, n = 0;
  void add(bool hit) {
    ++n;
    hits += hit ? 1 : 0;
  }
};

/// What was hidden, and what became of it.
struct HiddenOne {
  int effect = -1;    ///< place in effect_variants()
  double size = 0.0;  ///< in least moderate sizes
  double discrepancy =
      -1.0;  ///< whitened chi-square per feature above the floor, on an unseen record; -1: not flown
  bool detected = false, right = false;
};

struct CellResults {
  std::string name;
  HiddenTier tier;
  Count failed;                              ///< outcome other than ok
  Count detected, right, right_if_detected;  ///< of the first hidden effect
  Count any, both;                           ///< of two
  Count unknown, unknown_absorbable;         ///< flagged unknown; the second: effects declared absorbable
  Count wrong;        ///< named alone or with others, verdict "named", none of them hidden
  Count spurious;     ///< a right name with a further one that is none
  Count class_holds;  ///< of answers with a name or a class
  Count covered;
  std::vector<double> class_size;  ///< of the same answers
  std::vector<double> parameter_error;
  std::vector<double> gap_before, gap_after, gap_floor;  ///< trials with a visible discrepancy
  std::vector<double> gap_left;
  std::vector<HiddenOne> hidden;  ///< one a hidden effect
  struct OneEffect {
    Count detected, right, unknown, covered;
    std::vector<double> error;
  };
  std::map<int, OneEffect> by_effect;  ///< of all hidden effects, two count each
  /// Cells with one hidden effect: (hidden, named) with kNothing, kClass and kUnknown for what is no name; of several names the
  /// right one, or else the first.
  std::map<std::pair<int, int>, std::uint64_t> confusion;
  static constexpr int kNothing = -1, kClass = -2, kUnknown = -3, kFailed = -4;

  [[nodiscard]] std::uint64_t trials() const { return failed.n; }
};

/// Reads the rows of every cell.
Result<std::vector<CellResults>> read_results(const CampaignSpec& spec, const RowSource& rows);

/// Name of a place in effect_variants(), or of what is none.
std::string effect_name(int number);

}  // namespace fatmc::hidden_effect
