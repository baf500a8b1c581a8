#include "core/flight/closed_rate_loop.h"

#include <cmath>

namespace fatmc {

LinearModel closed_rate_loop(const Flight& flight, const Eigen::Vector3d& gain, bool turn_coordinator) {
  constexpr int kPhi = 6;
  static_assert(kLinearStateNames[kPhi] == "phi");
  LinearModel out = flight.sampled();
  LinearOutputMatrix feedback = out.c;
  if (turn_coordinator) {
    feedback(2, kPhi) -= kGravity / flight.aircraft().speed_m_s * std::cos(flight.trim().alpha_rad);
  }
  const LinearInputMatrix command = out.b * gain.asDiagonal();
  out.a -= command * feedback;
  out.b = command;
  return out;
}

}  // namespace fatmc
