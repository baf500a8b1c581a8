// The rows of a cell as time histories, and what alarms make of them.
#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "campaigns/base/study.h"

namespace fatmc::dynamics_change {

struct MonitoredRun {
  double epoch_s = 0.0, window_s = 0.0;
  double onset_s = 0.0;  ///< infinite: nothing changes
  double duration_s = 0.0, strength = 0.0, flown_s = 0.0;
  bool diverged = false;
  std::vector<double> csl, robust;
  std::array<std::vector<double>, 3> noise;

  [[nodiscard]] std::size_t epochs() const { return csl.size(); }
  /// Time of epoch i: it has seen all samples before.
  [[nodiscard]] double time(std::size_t i) const { return epoch_s * static_cast<double>(i + 1); }
};

/// Runs of a cell in the order of repetitions; rows without a flight are counted in `without_flight` alone.
struct MonitoredCell {
  std::vector<MonitoredRun> runs;
  std::uint64_t without_flight = 0;
};
MonitoredCell read_cell(std::uint32_t cell, const RowSource& rows);

}  // namespace fatmc::dynamics_change
