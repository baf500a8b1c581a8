// How far to trust an estimate: confidence regions, input SNR, noise, nonlinear distortion, widths of modes,
// constants of the bias; as fields of estimate.json and as lines for the terminal.
#pragma once

#include <nlohmann/json.hpp>

#include "coordinator/cli/estimate_report.h"

namespace fatmc::cli {

using Json = nlohmann::ordered_json;

/// [{"level", "kind", "radius"}]: univariate, bonferroni, simultaneous, joint at 75, 90, 95 and 99 %, in
/// standard deviations; null where the method has no law or q is too small for the kind.
Json confidence_json(const EstimatedRecord& e);

/// input_snr_db, low_snr_lines, noise, nonlinear_distortion, three_db_hz: fields that are null for methods
/// without them.
void add_quality(Json& json, const EstimatedRecord& e);

/// Bias with the three constants side by side and the constants themselves; null but for the fast LPM.
Json bias_variants_json(const EstimatedRecord& e);

/// Conditions, border lines, regions, SNR and nonlinear distortion in a few lines.
void print_quality(const EstimatedRecord& e);

}  // namespace fatmc::cli
