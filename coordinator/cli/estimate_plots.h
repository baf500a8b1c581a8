// An estimate as figures: magnitude and phase of every element with the region that holds it, and how far it
// is from a reference.
#pragma once

#include <optional>
#include <string>

#include "coordinator/cli/estimate_record.h"
#include "coordinator/cli/reference_response.h"
#include "campaigns/base/figure.h"

namespace fatmc::cli {

/// Columns are inputs; a row of magnitudes (dB) and one of phases (deg) an output. The band is the 95 %
/// confidence disc of F(2, 2q) (T 2.207), one standard deviation where the method has no law: |G| ± r and arg
/// G ± asin(r/|G|). Rings are border lines. With a reference also its curve and the MUAD envelopes about it.
plot::Figure response_figure(const EstimatedRecord& e, const std::optional<ReferenceResponse>& reference);

/// Error response function (T 3.6, 3.7), its cost (3.8) and the MUAD envelopes, in the same grid.
plot::Figure error_figure(const EstimatedRecord& e, const ReferenceResponse& reference);

}  // namespace fatmc::cli
