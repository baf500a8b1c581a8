#include "campaigns/base/campaign_spec.h"

#include <set>

#include "campaigns/base/cell_grid.h"
#include "campaigns/base/decoder.h"
#include "core/base/check.h"

namespace fatmc {

std::uint64_t CampaignSpec::trial_count() const {
  std::uint64_t count = 0;
  for (const Cell& cell : cells) count += cell.repetitions;
  return count;
}

TrialKey CampaignSpec::key(std::uint64_t index) const {
  for (std::uint32_t cell = 0; cell < cells.size(); ++cell) {
    if (index < cells[cell].repetitions) return {cell, index};
    index -= cells[cell].repetitions;
  }
  FATMC_CHECK(false, "the trial index is beyond the plan");
}

std::uint64_t CampaignSpec::index(TrialKey trial_key) const {
  FATMC_CHECK(trial_key.cell < cells.size(), "the cell is beyond the plan");
  std::uint64_t before = 0;
  for (std::uint32_t cell = 0; cell < trial_key.cell; ++cell) before += cells[cell].repetitions;
  return before + trial_key.repetition;
}

TrialSeed CampaignSpec::trial_seed(TrialKey trial_key) const {
  return {seed, name_hash(study), name_hash(cells.at(trial_key.cell).name), trial_key.repetition};
}

std::string CampaignSpec::identity() const {
  Tree meaning = tree;
  meaning.set("cell", Tree{Tree::Array{}, {}, 0});
  meaning.set("published", Tree{std::string(), {}, 0});          // figures to compare with change no result
  for (const char* key : {"stop", "watch"}) meaning.erase(key);  // nor does when to stop
  if (const Tree* table = meaning.find("campaign")) {
    Tree campaign = *table;
    campaign.erase("title");
    meaning.set("campaign", std::move(campaign));
  }
  std::string text = canonical_text(meaning) + "seed " + std::to_string(seed);
  for (const Cell& cell : cells) {
    Tree own = cell.tree;
    own.set("repetitions", Tree{std::int64_t{0}, {}, 0});
    own.erase("priority");
    text += canonical_text(own);
  }
  return hex(sha256(text));
}

// The name is that of a file, results/NAME.db, beside which FILE-journal and the like may stand.
namespace {

void check_name(Decoder& table, const std::string& name) {
  constexpr std::size_t kLongest = 200;  // of the 255 bytes of a file name
  if (name.empty()) table.reject("name", "is empty, write a plain file name");
  if (name.find('/') != std::string::npos) table.reject("name", "holds a '/', write a plain file name");
  if (name.size() > kLongest) {
    table.reject("name", "has " + std::to_string(name.size()) + " characters, write at most " +
                             std::to_string(kLongest));
  }
}

}  // namespace

namespace {

Status decode_cells(Decoder& top, std::vector<Cell>& cells) {
  std::set<std::string> names;
  for (const Tree* entry : top.tables("cell")) {
    Decoder table(*entry, "cell");
    Cell cell;
    cell.name = table.text("name");
    cell.repetitions =
        static_cast<std::uint64_t>(table.integer("repetitions", {.low = 1, .high = 1'000'000'000}));
    cell.priority = table.integer("priority", {.low = -1000, .high = 1000}, 0);
    cell.disperse = table.boolean("disperse", true);
    table.table("set", false);
    cell.tree = *entry;
    if (!names.insert(cell.name).second) {
      table.reject("name", "\"" + cell.name + "\" names two cells, write another name");
    }
    if (table.error()) return fail(*table.error());
    cells.push_back(std::move(cell));
  }
  return {};
}

}  // namespace

Result<CampaignSpec> decode_campaign(const Tree& tree) {
  Result<Tree> expanded = expand_factors(tree);
  if (!expanded) return fail(expanded.error());
  CampaignSpec spec;
  spec.tree = std::move(*expanded);
  Decoder top(spec.tree, "");
  if (const Tree* campaign = top.table("campaign")) {
    Decoder table(*campaign, "campaign");
    spec.study = table.text("study");
    spec.name = table.text("name", spec.study);
    spec.title = table.text("title", spec.name);
    spec.seed = static_cast<std::uint64_t>(table.integer("seed", {.low = 0}));
    check_name(table, spec.name);
    top.take(table.finish());
  }
  top.take(decode_cells(top, spec.cells));
  if (top.error()) return fail(*top.error());
  auto dispersions = decode_dispersions(spec.tree);
  if (!dispersions) return fail(dispersions.error());
  spec.dispersions = std::move(*dispersions);
  auto keep = decode_keep(spec.tree);
  if (!keep) return fail(keep.error());
  spec.keep = *keep;
  auto precision = decode_precision(spec.tree);
  if (!precision) return fail(precision.error());
  spec.precision = std::move(*precision);
  return spec;
}

}  // namespace fatmc
