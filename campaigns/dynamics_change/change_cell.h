// What changes in the flights of a cell, and when.
//
//   [[cell]]
//   name = "pitch_effectiveness"
//   change = ["control_effectiveness:axis=pitch,factor=0.5"]   # absent: nothing changes
//   strength = [0.4, 0.8]        # drawn for each flight instead of the first parameter, alike for all effects of the list ...
//   either_side = true           # ... and mirrored (1/0.4, 1/0.8) in half of the flights
//   onset_s = [450.0, 650.0]     # drawn, uniform
//   duration_s = 0.0             # of a drift
//   flight_s = 1000.0            # a multiple of the period
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "campaigns/flown/flown_cell.h"
#include "core/flight/effects/effect.h"
#include "core/robust/confident_stability.h"

namespace fatmc::dynamics_change {

struct ChangeCell {
  FlownCell flown;  ///< its experiment lasts for the whole flight
  int window_periods = 2;
  double epoch_s = 10.0;
  StabilityOptions judgement;
  std::vector<Effect> change;  ///< without onset
  std::optional<std::array<double, 2>> strength;
  bool either_side = false;
  std::array<double, 2> onset_s{};
  double duration_s = 0.0;
};

Result<ChangeCell> decode_change_cell(const CampaignSpec& spec, std::uint32_t index);

/// A flight's change: drawn from the trial's stream "effect"; empty where nothing changes.
std::vector<Effect> drawn_change(const ChangeCell& cell, const TrialSeed& trial);

}  // namespace fatmc::dynamics_change
