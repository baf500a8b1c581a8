// The nominal plant G_n that an estimate is judged against (T section 2.8.3), from a MODEL file:
//
//   kind = "aircraft"      campaigns/models/fat.toml describes the keys. Sampled at the record's rate with held commands;
//                          poles beyond 1 − 1e-8 are moved onto that circle (nominal_model.h).
//   kind = "state_space"   state_space_model.h describes the keys.
//                          Poles between 1 − 1e-8 and 1 + 1e-6 (integrators, to rounding) are moved as above; poles further
//                          out are refused.
//   kind = "frf"           file = "frm.csv", relative to the TOML: a response as `fatmc estimate` writes it. A path that
//                          ends in .csv is taken as such a response itself. It has no poles to check: that the loop
//                          around it is stable is taken from the user.
//
// G_n must be stable, and the loop u = K (r − y) around it too: (2.260) carries the stability of that loop over to the
// estimated one, and has nothing to carry where there is none.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/record/record.h"
#include "core/stability/estimate_stability.h"

namespace fatmc {

/// What the record is measured with: names in its order, K, and where responses are needed.
struct MeasuredLoop {
  std::vector<std::string> inputs, outputs;
  double rate_hz = 0.0;
  Hold hold = Hold::zoh;
  Eigen::MatrixXd controller;        ///< n_in × n_out
  std::vector<double> frequency_hz;
};

struct NominalPlant {
  std::string kind;
  NominalLoop loop;
  int moved_poles = 0;
  std::optional<double> largest_pole;              ///< |z| before moving; nothing for a response
  std::optional<double> largest_closed_loop_pole;  ///< |z| with K
  /// Effects of an aircraft's model file that its linearised airframe does not show (aircraft_file.h).
  std::vector<std::string> effects_not_shown;
};

/// "MODEL: not in the nominal plant: transport_delay:delay_s=0.03, ... (...)", or nothing where it shows all of them.
std::string effects_not_shown(const NominalPlant& nominal, const std::string& path);

/// Reads MODEL, picks the channels of `measured` by name, checks stability with and without K, and evaluates G_n.
Result<NominalPlant> read_nominal_plant(const std::string& path, const MeasuredLoop& measured);

}  // namespace fatmc
