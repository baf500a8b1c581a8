// What a cell of the coverage study flies and how it is estimated.
#pragma once

#include "campaigns/base/campaign_spec.h"
#include "campaigns/base/experiment.h"
#include "core/base/error.h"
#include "core/flight/aircraft.h"
#include "core/ident/lpm_grid.h"

namespace fatmc::coverage {

struct CoverageCell {
  Aircraft aircraft;
  Experiment experiment;
  LpmOptions estimator;
  bool speed_correction = true;  ///< T (3.4), to the trim speed
};

/// Decodes the tables `model`, `experiment` and `estimator` of the spec; a cell may override `plant`,
/// `ranges_hz`, `amplitude_rad_s`, `turbulence_sigma_m_s`, `rk4_step_s` and `turn_coordinator` of the
/// experiment.
Result<CoverageCell> decode_cell(const CampaignSpec& spec, std::uint32_t cell);

}  // namespace fatmc::coverage
