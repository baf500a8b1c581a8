// A spec as a campaign that is fit to run.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
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

/// A part of a campaign: of each cell's repetitions the `number`-th of `count` equal ranges, without gap and
/// overlap.
struct Shard {
  std::uint64_t number = 1;  ///< from 1
  std::uint64_t count = 1;

  /// [first, last) of a cell.
  [[nodiscard]] std::pair<std::uint64_t, std::uint64_t> range(std::uint64_t repetitions) const;
};

/// "2/4"
Result<Shard> parse_shard(const std::string& text);

/// Reads, changes and decodes a spec, and lets its study prepare every cell, so that whatever is wrong is
/// known before a process is started or a file written.
Result<CampaignSpec> read_campaign(const std::string& path, const SpecChanges& changes);

}  // namespace fatmc::cli
