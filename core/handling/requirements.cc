#include "core/handling/requirements.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fatmc {
namespace {

/// Cycles until half the amplitude; above 0 for a damped mode.
bool halves_within(const Mode& mode, double cycles) {
  return -mode.s.real() * cycles * mode.period_s() >= std::numbers::ln2;
}

bool doubles_within(const Mode& mode, double seconds) { return mode.s.real() * seconds >= std::numbers::ln2; }

}  // namespace

bool meets_cs27(const Mode& mode, PilotCrew crew) {
  if (!mode.oscillatory()) return true;
  const double period = mode.period_s();
  const bool damped = mode.s.real() < 0.0;
  if (crew == PilotCrew::single) {
    if (period < 5.0) return halves_within(mode, 1.0);
    if (period < 10.0) return halves_within(mode, 2.0);
    return period >= 20.0 || damped;
  }
  if (period < 5.0) return halves_within(mode, 2.0);
  if (period < 10.0) return damped;
  return !doubles_within(mode, 10.0);
}

Approval cs27_approval(std::span<const ModeShare> modes, double least_share) {
  const auto all = [&](PilotCrew crew) {
    return std::all_of(modes.begin(), modes.end(), [&](const ModeShare& mode) {
      return mode.share < least_share || meets_cs27(mode.mode, crew);
    });
  };
  if (all(PilotCrew::single)) return Approval::single_pilot;
  return all(PilotCrew::two) ? Approval::dual_pilot : Approval::none;
}

std::string_view approval_name(Approval approval) {
  switch (approval) {
    case Approval::single_pilot:
      return "single pilot";
    case Approval::dual_pilot:
      return "two pilots";
    case Approval::none:
      break;
  }
  return "none";
}

int ads33_level(const Mode& mode) {
  if (!mode.oscillatory()) return 1;
  const double damping = mode.damping();
  if (std::abs(mode.s) >= 0.5) return damping >= 0.35 ? 1 : (damping >= 0.0 ? 2 : 3);
  if (damping >= 0.0) return 1;
  return doubles_within(mode, 10.0) ? 3 : 2;
}

int ads33_level(std::span<const ModeShare> modes, double least_share) {
  int worst = 1;
  for (const ModeShare& mode : modes) {
    if (mode.share >= least_share) worst = std::max(worst, ads33_level(mode.mode));
  }
  return worst;
}

}  // namespace fatmc
