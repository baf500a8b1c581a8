// The published figures of a study, decoded from the `published` file of its spec.
#pragma once

#include <string>
#include <vector>

#include "campaigns/base/campaign_spec.h"
#include "core/base/error.h"

namespace fatmc {

struct PublishedFigure {
  std::string table, row, quantity, unit;
  double value = 0.0;
  bool upper_bound = false;  ///< "< value" is printed: `bound = true`
  std::string source;        ///< line of the source text
};

/// Empty when the spec names no published figures.
Result<std::vector<PublishedFigure>> decode_published(const CampaignSpec& spec);

/// The one with that table, row and quantity, or null.
const PublishedFigure* find_published(const std::vector<PublishedFigure>& figures, const std::string& table,
                                      const std::string& row, const std::string& quantity);

/// Whether a cell repeats what is published: `compare` of the cell, true where absent.
bool compared_with_print(const CampaignSpec& spec, std::uint32_t cell);

}  // namespace fatmc
