// A spec as a campaign that is fit to run.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "campaigns/base/campaign_spec.h"
#include "core/base/error.h"

namespace fatmc::cli {

/// What the command line changes in a spec.
struct SpecChanges {
  std::optional<std::int64_t> trials;  ///< repetitions of every cell
  std::optional<double> scale;         ///< multiplies repetitions, after `trials`
  std::optional<std::int64_t> seed;
  std::string size;  ///< of the spec's [size.NAME]; empty: as the spec stands
};

/// Adds --trials, --scale, --seed and --size.
void add_spec_options(CLI::App& command, SpecChanges& changes);

/// The same as words of a command line.
std::vector<std::string> words_of(const SpecChanges& changes);

/// Reads, changes and decodes a spec, and lets its study prepare every cell, so that whatever is wrong is
/// known before a process is started or a file written.
Result<CampaignSpec> read_campaign(const std::string& path, const SpecChanges& changes);

}  // namespace fatmc::cli
