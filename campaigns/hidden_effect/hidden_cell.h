// A cell of the hidden-effect study.
//
//   [search]
//   null_flights = 1000          # behind the law of chance
//   classes = [["cn_r", "cy_beta"]]   # what one record cannot separate, declared before the run: names of effects
//   [[cell]]
//   name = "single"
//   repetitions = 2000
//   hide = 1                     # effects at once
//   size = 1.0                   # share of a moderate size
//   hidden = ["transport_delay", "control_effectiveness:axis=roll"]   # ids or names that it draws from
//   taken_out = true             # what is hidden is no candidate of the search in that trial
//   nominal_error = 0.04         # of the derivatives in `uncertain`
//   uncertain = ["cl_p", "cm_alpha"]
//   turbulence_error = 0.2       # of the level's logarithm; the search then takes it for unknown
#pragma once

#include <string>
#include <vector>

#include "campaigns/flown/flown_cell.h"
#include "campaigns/hidden_effect/hidden_draw.h"

namespace fatmc::hidden_effect {

struct HiddenCell {
  FlownCell flown;
  Tier tier;
  bool taken_out = false;
  std::vector<std::vector<std::string>> classes;
  int null_flights = 1000;
  std::string search_key;  ///< equal for cells whose search is the same
};

Result<HiddenCell> decode_hidden_cell(const CampaignSpec& spec, std::uint32_t cell);

}  // namespace fatmc::hidden_effect
