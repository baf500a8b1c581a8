#include "coordinator/cli/campaign_input.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "campaigns/base/cell_grid.h"
#include "campaigns/base/decoder.h"
#include "campaigns/base/prepared_trials.h"
#include "campaigns/base/published_figures.h"
#include "campaigns/registry_trials.h"
#include "coordinator/input/toml_file.h"
#include "core/base/text.h"

namespace fatmc::cli {
namespace {

constexpr std::int64_t kMostRepetitions = 1'000'000'000;

Tree option_value(std::int64_t value, const char* option) { return Tree{value, option, 0}; }

// The tree must have been decoded without error.
Status apply(const SpecChanges& changes, Tree& tree, const CampaignSpec& decoded) {
  if (changes.seed) {
    Tree campaign = *tree.find("campaign");
    campaign.set("seed", option_value(*changes.seed, "--seed"));
    tree.set("campaign", std::move(campaign));
  }
  if (!changes.trials && !changes.scale) return {};
  Tree cells = *tree.find("cell");
  auto& items = std::get<Tree::Array>(cells.value).items;
  for (std::size_t i = 0; i < items.size(); ++i) {
    const auto repetitions = changes.trials.value_or(static_cast<std::int64_t>(decoded.cells[i].repetitions));
    const double scaled = std::round(static_cast<double>(repetitions) * changes.scale.value_or(1.0));
    if (!(scaled <= static_cast<double>(kMostRepetitions))) {
      return fail(Error{"", 0, "--scale",
                        "gives more than 1000000000 repetitions or is no number, write one such as 0.5"});
    }
    const auto option = changes.scale ? "--scale" : "--trials";
    items[i].set("repetitions",
                 option_value(std::max<std::int64_t>(1, static_cast<std::int64_t>(scaled)), option));
  }
  tree.set("cell", std::move(cells));
  return {};
}

// [size.small] makes a campaign cheap: `repetitions` is the most of a cell, and what its table `set` gives is
// set in every cell. Sizes that are not asked for leave no trace. `--size full` of a spec without it is
// the spec as it stands.
Status apply_size(const std::string& size, Tree& tree) {
  const Tree* sizes = tree.find("size");
  const Tree* own = sizes != nullptr && !size.empty() ? sizes->find(size) : nullptr;
  if (own == nullptr) {
    if (!size.empty() && size != "full") {
      return fail(
          Error{tree.file, 0, "--size",
                "the spec has no [size." + size + "], write one with repetitions = N or use --scale"});
    }
    tree.erase("size");
    return {};
  }
  const Tree given = *own;
  Decoder table(given, "size." + size);
  const std::int64_t most =
      table.integer("repetitions", {.low = 1, .high = kMostRepetitions}, kMostRepetitions);
  table.table("set", false);
  if (Status status = table.finish(); !status) return status;
  tree.erase("size");
  const Tree* found = tree.find("cell");
  if (found == nullptr || found->array() == nullptr) return {};  // the decoder says what is wrong
  Tree cells = *found;
  for (Tree& cell : std::get<Tree::Array>(cells.value).items) {
    if (cell.table() == nullptr) continue;
    const Tree* now = cell.find("repetitions");
    const auto* count = now != nullptr ? std::get_if<std::int64_t>(&now->value) : nullptr;
    if (count != nullptr && *count > most) cell.set("repetitions", Tree{most, now->file, now->line});
    Tree set = cell.find("set") != nullptr ? *cell.find("set") : Tree{Tree::Table{}, given.file, given.line};
    const auto values = values_set_by(given);
    if (values.empty() || set.table() == nullptr) continue;
    for (const auto& [path, value] : values) set.set(path, value);
    cell.set("set", std::move(set));
  }
  tree.set("cell", std::move(cells));
  return {};
}

}  // namespace

void add_spec_options(CLI::App& command, SpecChanges& changes) {
  command.add_option("--trials", changes.trials, "repetitions of each cell, instead of the spec's")
      ->check(CLI::Range(std::int64_t{1}, kMostRepetitions));
  command.add_option("--scale", changes.scale, "multiplies repetitions")->check(CLI::PositiveNumber);
  command
      .add_option("--size", changes.size,
                  "a size that the spec gives, [size.small] for instance; full: the spec as it stands")
      ->check(CLI::Validator(
          [](const std::string& name) {
            const bool word = !name.empty() && std::all_of(name.begin(), name.end(), [](unsigned char c) {
              return std::isalnum(c) != 0 || c == '_' || c == '-';
            });
            return word ? std::string() : "not the name of a size";
          },
          "NAME"));
  command.add_option("--seed", changes.seed, "seed, instead of the spec's")
      ->check(CLI::Range(std::int64_t{0}, std::numeric_limits<std::int64_t>::max()));
}

std::vector<std::string> words_of(const SpecChanges& changes) {
  std::vector<std::string> words;
  if (changes.trials) words.insert(words.end(), {"--trials", std::to_string(*changes.trials)});
  if (changes.scale) words.insert(words.end(), {"--scale", shortest(*changes.scale)});
  if (changes.seed) words.insert(words.end(), {"--seed", std::to_string(*changes.seed)});
  if (!changes.size.empty()) words.insert(words.end(), {"--size", changes.size});
  return words;
}

std::pair<std::uint64_t, std::uint64_t> Shard::range(std::uint64_t repetitions) const {
  return {repetitions * (number - 1) / count, repetitions * number / count};
}

Result<Shard> parse_shard(const std::string& text) {
  constexpr std::uint64_t kMostShards = 1'000'000;
  const std::size_t slash = text.find('/');
  Shard shard;
  const auto read = [&](std::size_t first, std::size_t last, std::uint64_t& value) {
    const auto end = std::from_chars(text.data() + first, text.data() + last, value);
    return end.ec == std::errc() && end.ptr == text.data() + last;
  };
  if (slash == std::string::npos || !read(0, slash, shard.number) ||
      !read(slash + 1, text.size(), shard.count) || shard.number < 1 || shard.number > shard.count ||
      shard.count > kMostShards) {
    return fail(
        Error{"", 0, "--shard", "\"" + text + "\" is no shard, write for instance 2/4: the second of four"});
  }
  return shard;
}

Result<CampaignSpec> read_campaign(const std::string& path, const SpecChanges& changes) {
  Result<Tree> tree = read_toml_resolved(path);
  if (!tree) return fail(tree.error());
  if (Status status = apply_size(changes.size, *tree); !status) return fail(status.error());
  Result<CampaignSpec> spec = decode_campaign(*tree);
  if (!spec) return spec;
  Tree changed = spec->tree;
  if (Status status = apply(changes, changed, *spec); !status) return fail(status.error());
  spec = decode_campaign(changed);
  if (!spec) return spec;
  const Result<const TrialStudy*> study = require_trial_study(*spec);
  if (!study) return fail(study.error());
  for (std::uint32_t cell = 0; cell < spec->cells.size(); ++cell) {
    const auto prepared = prepare_trials(**study, *spec, cell);
    if (!prepared) return fail(prepared.error());
  }
  // Read by the tables alone, hours later.
  if (const auto published = decode_published(*spec); !published) return fail(published.error());
  return spec;
}

}  // namespace fatmc::cli
