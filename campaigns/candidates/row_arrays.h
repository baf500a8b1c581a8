// Names of what a trial of the candidates study leaves in its row, shared by the trial that writes and the
// summary that reads.
#pragma once

#include <array>
#include <string_view>
#include <vector>

namespace fatmc::candidates {

// A value a model, in the order past (descending), future, order (both ascending).
inline constexpr std::string_view kPast = "past", kFuture = "future", kOrder = "order";
inline constexpr std::string_view kState = "state";   ///< a ModelState
inline constexpr std::string_view kAgreement = "d1";  ///< overall index of agreement, H (11); 0 without
inline constexpr std::string_view kRms = "j_rms";     ///< H (9), ft/s, deg/s, deg; 0 without
inline constexpr std::string_view kTheil = "theil";   ///< Theil's coefficient in the same units; 0 without
/// kOutputs values a model: d1 of each output (H 10); 0 without.
inline constexpr std::string_view kOutputAgreement = "d1_outputs";
/// The same of the roll rate alone in the first lateral multistep (H Figs. 2, 3); deg/s.
inline constexpr std::string_view kRollAgreement = "roll_d1", kRollRms = "roll_rms";
inline constexpr std::string_view kNorm = "norm";  ///< spectral norm of A_K^p; 0 without
inline constexpr std::string_view kLambda =
    "lambda";  ///< a value a past window; 0 where all its models failed

enum class ModelState { ok = 0, not_identified = 1, not_validated = 2 };

// Models of the orders that are selected from, in the same order: kAnalysed holds their index in the lists
// above. Models without a continuous counterpart are left out.
inline constexpr std::string_view kAnalysed = "analysed";
inline constexpr std::string_view kMagnitude =
    "p_delta_y_db";  ///< kFrequencies values, deg/s per per cent in dB

// The model itself in real modal form (modal_model of discrete_model.h), n its order: eigenvalues of A, n real
// parts, then n imaginary ones; B, n x 4, and C, 8 x n, row by row.
inline constexpr std::string_view kEigenvalues = "eigenvalues", kModalB = "modal_b", kModalC = "modal_c";

// Metrics: how many models, and how many failed at which step.
inline constexpr std::string_view kModels = "models", kNotIdentified = "not_identified",
                                  kNotValidated = "not_validated", kNotContinuous = "not_continuous";

/// The modes that H prints, in the order of its text.
struct TrackedMode {
  const char* name;
  int vehicle;  ///< 0 bare, 1 stabilized (14), 2 optimized (15)
  double period_s, damping;
  /// The angular rate, by its output, that moves most in the mode; -1: whichever. With the SCAS the Dutch roll is as fast
  /// as the phugoid.
  int rate;
};
inline constexpr std::array<TrackedMode, 5> kTrackedModes = {
    {{"phugoid, bare", 0, 19.2, -0.16, 4},
     {"phugoid, SCAS", 1, 4.9, 0.4, 4},
     {"roll/flap, SCAS", 1, 0.45, 0.32, -1},
     {"lead-lag, SCAS", 1, 0.55, 0.03, -1},
     {"roll/flap, SCAS and filter", 2, 0.43, 0.58, -1}}};

/// The order whose selection H shows in Figs. 5 to 7, and the two models of its Figs. 2 and 3.
inline constexpr int kShownOrder = 12;
struct RollModel {
  double rms_deg_s, agreement;
};
inline constexpr std::array<RollModel, 2> kRollModels = {{{0.82, 0.95}, {1.77, 0.91}}};

/// What is judged by CS-27 and ADS-33: a vehicle's response of an output to an input.
struct JudgedResponse {
  const char* name;
  int vehicle, output, input;
  int published_level;
};
inline constexpr std::array<JudgedResponse, 4> kJudged = {{{"pitch, bare", 0, 4, 0, 2},
                                                           {"pitch, SCAS", 1, 4, 0, 1},
                                                           {"roll, SCAS", 1, 3, 1, 2},
                                                           {"roll, SCAS and filter", 2, 3, 1, 1}}};

/// Of the transfer functions p/delta_y: 40 from 0.1 to 35 rad/s, equally spaced on a logarithmic axis.
inline constexpr int kFrequencies = 40;
double frequency_rad_s(int index);
const std::vector<double>& study_frequencies();

}  // namespace fatmc::candidates
