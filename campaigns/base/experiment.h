// What is flown: excitation, controller, environment, sensors, simulation. Decoded from a file with
// kind = "experiment", see campaigns/experiments.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "campaigns/base/aircraft_model.h"
#include "campaigns/base/tree.h"
#include "core/base/error.h"
#include "core/flight/flight.h"
#include "core/random/random_stream.h"
#include "core/signal/multisine.h"

namespace fatmc {

/// Phases of the lines.
enum class Phases {
  random,  ///< uniform, from the trial's stream: T's choice (its footnote 42: one fixed signal would distort
           ///< a campaign)
  schroeder,  ///< a fixed signal; axes that share lines would get the same one, so only with zippered lines
  low_crest,  ///< random ones, then a nearby minimum of the crest factor (core/signal/crest_factor.h): about
              ///< 0.2 s an axis
};

struct Excitation {
  double period_s = 0.0;
  int periods = 0;
  std::vector<FrequencyRange> ranges;       ///< T Table 5-1
  std::array<double, 3> amplitude_rad_s{};  ///< of every line, on p, q and r (open loop: normalised commands)
  Phases phases = Phases::random;
  bool zippered = false;  ///< every third line for each axis, instead of all lines on all axes
  // Follows from the above and the rate.
  int period_samples = 0;
  std::vector<int> lines;

  /// Lines that axis 0, 1 or 2 excites.
  [[nodiscard]] std::vector<int> lines_of(int axis) const;
};

struct Experiment {
  Excitation excitation;
  FlightSetup flight;
};

class Decoder;
/// Rows [first, last, step] in Hz.
std::vector<FrequencyRange> decode_ranges(Decoder& table, std::string_view key);

/// `model` brings the gyros that the experiment names by grade.
Result<Experiment> decode_experiment(const Tree& tree, const AircraftModel& model);

/// Where an error of Flight::prepare stands: its key in the experiment (under the name it has there), or else
/// the model.
Error locate_flight_error(const Error& error, const Tree& model, const Tree& experiment);

/// Lines and samples of a period from ranges, period and rate; `where` names the table for messages.
Status resolve_excitation(Excitation& excitation, double rate_hz, const Tree& where);

/// Multisines of the three axes; random numbers come from the stream "excitation" of the trial, axis after
/// axis.
std::array<Multisine, 3> reference_multisines(const Experiment& experiment, const TrialSeed& trial);
/// Their samples over all periods.
Eigen::MatrixX3d reference_signal(const Experiment& experiment, const TrialSeed& trial);

}  // namespace fatmc
