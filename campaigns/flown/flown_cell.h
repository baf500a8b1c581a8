// What a cell of a flown study flies and how it is estimated.
//
//   model = "../models/fat.toml"
//   experiment = "../experiments/chapter5.toml"
//   [estimator]                  # fast LPM, indirect
//   n_e = 9
//   order = 2
//   n_transient = 5
//   speed_correction = true      # T (3.4), to the trim speed
#pragma once

#include <span>
#include <string_view>

#include "campaigns/base/aircraft_model.h"
#include "campaigns/base/campaign_spec.h"
#include "campaigns/base/experiment.h"
#include "core/base/error.h"
#include "core/flight/aircraft.h"
#include "core/ident/lpm_grid.h"

namespace fatmc {

struct FlownCell {
  AircraftModel model;
  Experiment experiment;
  LpmOptions estimator;
  bool speed_correction = true;
};

/// Decodes the tables `model`, `experiment` and `estimator` of the spec; a cell may override `plant`,
/// `ranges_hz`, `amplitude_rad_s`, `turbulence_sigma_m_s`, `rk4_step_s`, `turn_coordinator` and
/// `gusts_from_calm` of the experiment, and say `compare = false` where it is no repetition of what is published
/// (published_figures.h).
/// `own_tables` and `own_keys` (of the cell) belong to the study, which decodes them itself.
Result<FlownCell> decode_flown_cell(const CampaignSpec& spec, std::uint32_t cell,
                                    std::span<const char* const> own_tables = {},
                                    std::span<const char* const> own_keys = {});

}  // namespace fatmc
