// A cell of the hidden-effect study: hidden_tier.h, what is flown, and the search.
//
//   [search]
//   null_flights = 1000          # behind the law of chance
//   classes = [["cn_r", "cy_beta"]]   # what one record cannot separate, declared before the run: names of effects
#pragma once

#include <string>
#include <vector>

#include "campaigns/flown/flown_cell.h"
#include "campaigns/hidden_effect/hidden_tier.h"

namespace fatmc::hidden_effect {

struct HiddenCell {
  FlownCell flown;
  HiddenTier tier;
  std::vector<std::vector<std::string>> classes;  ///< ids or names
  int null_flights = 1000;
  std::string search_key;  ///< equal for cells whose search is the same, levels apart
};

Result<HiddenCell> decode_hidden_cell(const CampaignSpec& spec, std::uint32_t cell);

}  // namespace fatmc::hidden_effect
