#include "coordinator/cli/plan_listing.h"

#include <cstdio>
#include <filesystem>

#include "campaigns/base/cell_grid.h"
#include "coordinator/store/campaign_store.h"
#include "core/base/text.h"

namespace fatmc::cli {
namespace {

unsigned long long wide(std::uint64_t number) { return number; }

void print_cell(const Cell& cell, bool dispersions) {
  std::string extra;
  if (cell.priority != 0) extra += "  priority " + std::to_string(cell.priority);
  if (dispersions && !cell.disperse) extra += "  not dispersed";
  std::printf("  %s: %llu trials%s\n", cell.name.c_str(), wide(cell.repetitions), extra.c_str());
  for (const auto& [path, value] : values_set_by(cell.tree)) {
    std::printf("    %s = %s\n", path.c_str(), canonical_text(value).c_str());
  }
}

void print_dispersion(const Dispersion& d) {
  static constexpr const char* kLaws[] = {"uniform", "normal", "truncated normal", "log-normal",
                                          "multivariate normal"};
  static constexpr const char* kApplies[] = {"", ", added", ", as a factor"};
  std::string numbers;
  const auto add = [&](const char* name, double value) {
    numbers += std::string(" ") + name + " " + shortest(value);
  };
  for (std::size_t i = 0; i < d.centre.size(); ++i) {
    add(d.law == Dispersion::Law::log_normal ? "median" : "mean", d.centre[i]);
    add(d.law == Dispersion::Law::log_normal ? "log_sd" : "sd", d.spread[i]);
  }
  if (d.law == Dispersion::Law::uniform || d.law == Dispersion::Law::truncated_normal) {
    add("low", d.low);
    add("high", d.high);
  }
  std::printf("  drawn: %s (%s): %s,%s%s\n", join(d.names).c_str(), join(d.paths).c_str(),
              kLaws[static_cast<std::size_t>(d.law)], numbers.c_str(),
              kApplies[static_cast<std::size_t>(d.apply)]);
}

}  // namespace

void print_plan(const CampaignSpec& spec, const std::string& database) {
  std::printf("campaign %s (study %s, seed %llu): %zu cells, %llu trials\n", spec.name.c_str(),
              spec.study.c_str(), wide(spec.seed), spec.cells.size(), wide(spec.trial_count()));
  for (const Cell& cell : spec.cells) print_cell(cell, !spec.dispersions.empty());
  for (const Dispersion& dispersion : spec.dispersions) print_dispersion(dispersion);
  if (spec.precision && spec.precision->half_width) {
    std::printf("  each cell ends when %s is known to within %s at %s %%\n", spec.precision->metric.c_str(),
                shortest(*spec.precision->half_width).c_str(),
                significant(100.0 * spec.precision->sequence.level, 4).c_str());
  }
  if (!std::filesystem::exists(database)) {
    std::printf("database: %s, which does not exist yet\n", database.c_str());
    return;
  }
  const Result<CampaignReader> reader = CampaignReader::open(database);
  if (!reader) {
    std::printf("database: %s\n", reader.error().text().c_str());
  } else if (reader->spec().identity() != spec.identity()) {
    std::printf("database: %s is of another spec or seed\n", database.c_str());
  } else {
    std::printf("database: %s, %llu trials stored\n", database.c_str(), wide(reader->stored()));
  }
}

}  // namespace fatmc::cli
