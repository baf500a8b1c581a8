// The synthetic flight test: eight pilot-like sweeps for identification and eight 3-2-1-1 multisteps for
// validation (H Table 1), two of each a control.
//
// A sweep runs from sweep_low_hz to sweep_high_hz with a pilot's unsteadiness: frequency and amplitude wander
// slowly, and the amplitude grows to the maximum of the table. The bare aircraft is unstable, so the pilot
// holds it near the reference by pulses on all controls, at irregular times, against attitude, rate and speed
// (H 2.2: uncorrelated, pulse-type inputs on the secondary controls). Multisteps begin in trim and are flown
// without pulses, the second of a control with the opposite sign. With the SCAS the controls are
//   u[n] = pilot[n] - scas K y_m[n-1],   K of H (14), y_m the measured outputs.
// Gusts act as airspeed: -(A - I) on their components of u, v, w. Outputs are measured with white noise.
#pragma once

#include <vector>

#include "campaigns/candidates/candidates_spec.h"
#include "core/random/random_stream.h"
#include "core/subspace/maneuvers.h"

namespace fatmc::candidates {

struct FlownTest {
  std::vector<Maneuver> sweeps, multisteps;
};

/// Every draw comes from streams of `seed`, one set a maneuver.
FlownTest fly_test(const Truth& truth, const FlightTest& test, const TrialSeed& seed);

/// The same without offsets, as models are identified from and validated on: means of the sweeps, first samples of the
/// multisteps are taken off.
FlownTest recorded_test(const Truth& truth, const FlightTest& test, const TrialSeed& seed);

}  // namespace fatmc::candidates
