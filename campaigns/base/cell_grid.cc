#include "campaigns/base/cell_grid.h"

#include <algorithm>
#include <cstdint>
#include <optional>

#include "campaigns/base/decoder.h"
#include "campaigns/base/spec_path.h"
#include "core/base/text.h"

namespace fatmc {
namespace {

constexpr std::size_t kMostCells = 100'000;

struct Level {
  std::string label;
  std::vector<Tree> values;  // one a path
  std::optional<std::int64_t> repetitions;
};

struct Factor {
  std::string name;
  std::vector<std::string> paths;
  std::vector<Level> levels;
};

// A value as part of a cell's name.
std::string label_of(const Tree& value) {
  if (const auto* text = std::get_if<std::string>(&value.value)) return *text;
  const Tree::Array* array = value.array();
  if (array == nullptr) return canonical_text(value);
  std::string out;
  for (const Tree& item : array->items) out += (out.empty() ? "" : " ") + label_of(item);
  return "[" + out + "]";
}

void decode_levels(Decoder& table, const Tree& entry, Factor& out) {
  const bool linked = out.paths.size() > 1 || entry.find("paths") != nullptr;
  table.skip("values");
  const Tree* values = entry.find("values");
  if (values == nullptr || values->array() == nullptr || values->array()->items.empty()) {
    return table.reject("values", "is no list of values, write [value, value, ...]");
  }
  for (const Tree& item : values->array()->items) {
    Level level;
    level.label = label_of(item);
    level.values = {item};
    if (linked) {
      if (item.array() == nullptr || item.array()->items.size() != out.paths.size()) {
        return table.reject("values", "holds no list of " + std::to_string(out.paths.size()) +
                                          " values, write [[value, ...], ...] with a value a path");
      }
      level.values = item.array()->items;
    }
    out.levels.push_back(std::move(level));
  }
  const std::size_t n = out.levels.size();
  if (table.has("labels")) {
    const std::vector<std::string> labels = table.texts("labels");
    if (labels.size() != n)
      return table.reject("labels", "is not of the size of values, write a label a value");
    for (std::size_t i = 0; i < n; ++i) out.levels[i].label = labels[i];
  }
  if (table.has("repetitions")) {
    const std::vector<double> counts = table.reals("repetitions", n, {.low = 1, .high = 1e9});
    for (std::size_t i = 0; i < counts.size(); ++i) {
      if (counts[i] != static_cast<double>(static_cast<std::int64_t>(counts[i]))) {
        return table.reject("repetitions", "holds a fraction, write integers");
      }
      out.levels[i].repetitions = static_cast<std::int64_t>(counts[i]);
    }
  }
}

Result<Factor> decode_factor(const Tree& entry) {
  Decoder table(entry, "factor");
  Factor out;
  const bool linked = table.has("paths");
  const char* key = linked ? "paths" : "path";
  out.paths = linked ? table.texts("paths") : std::vector{table.text("path")};
  for (const std::string& path : out.paths) {
    if (!is_path(path)) table.reject(key, "\"" + path + "\" is no path, write one such as estimator.n_e");
    if (is_of_engine(path)) table.reject(key, "\"" + path + "\" is not for a cell to set");
  }
  if (out.paths.empty()) table.reject(key, "is empty, write a list of paths");
  if (table.error()) return fail(*table.error());
  out.name = table.text("name", last_component(out.paths.front()));
  decode_levels(table, entry, out);
  if (Status status = table.finish(); !status) return fail(status.error());
  return out;
}

struct MadeCell {
  Tree tree;
  std::optional<std::int64_t> repetitions;  // the largest that a factor gave
};

// The cell with one more factor at one of its values.
Result<MadeCell> at_level(const MadeCell& cell, const Factor& factor, const Level& level) {
  MadeCell made = cell;
  const Tree* name = cell.tree.find("name");
  const auto* text = name != nullptr ? std::get_if<std::string>(&name->value) : nullptr;
  if (text == nullptr) return fail(Error{cell.tree.file, cell.tree.line, "cell.name", "is missing"});
  made.tree.set("name", Tree{*text + ", " + factor.name + "=" + level.label, name->file, name->line});
  const Tree* before = cell.tree.find("set");
  Tree set = before != nullptr ? *before : Tree{Tree::Table{}, cell.tree.file, cell.tree.line};
  if (set.table() == nullptr)
    return fail(Error{set.file, set.line, "cell.set", "is no table, write [cell.set]"});
  const auto present = values_set_by(cell.tree);
  for (std::size_t i = 0; i < factor.paths.size(); ++i) {
    const auto same = [&](const auto& entry) { return entry.first == factor.paths[i]; };
    if (std::any_of(present.begin(), present.end(), same)) {
      return fail(
          Error{level.values[i].file, level.values[i].line, "factor.path",
                "\"" + factor.paths[i] + "\" is set by the cell or another factor, too; keep one of them"});
    }
    set.set(factor.paths[i], level.values[i]);
  }
  made.tree.set("set", std::move(set));
  if (level.repetitions) made.repetitions = std::max(made.repetitions.value_or(0), *level.repetitions);
  return made;
}

Status multiply(const Factor& factor, std::vector<MadeCell>& cells) {
  std::vector<MadeCell> out;
  for (const MadeCell& cell : cells) {
    for (const Level& level : factor.levels) {
      Result<MadeCell> made = at_level(cell, factor, level);
      if (!made) return fail(made.error());
      out.push_back(std::move(*made));
      if (out.size() > kMostCells) {
        return fail(Error{level.values[0].file, level.values[0].line, "factor",
                          "the factors make more than 100000 cells, write fewer values"});
      }
    }
  }
  cells = std::move(out);
  return {};
}

void flatten(const Tree& table, const std::string& prefix, std::vector<std::pair<std::string, Tree>>& out) {
  for (const auto& [name, entry] : table.table()->entries) {
    const std::string path = prefix.empty() ? name : prefix + "." + name;
    if (entry.table() != nullptr) {
      flatten(entry, path, out);
    } else {
      out.emplace_back(path, entry);
    }
  }
}

}  // namespace

Result<Tree> expand_factors(const Tree& spec) {
  if (spec.find("factor") == nullptr) return spec;
  Decoder top(spec, "");
  std::vector<Factor> factors;
  for (const Tree* entry : top.tables("factor")) {
    Result<Factor> factor = decode_factor(*entry);
    if (!factor) return fail(factor.error());
    factors.push_back(std::move(*factor));
  }
  std::vector<MadeCell> cells;
  for (const Tree* cell : top.tables("cell")) cells.push_back({*cell, {}});
  if (top.error()) return fail(*top.error());
  for (const Factor& factor : factors) {
    if (Status status = multiply(factor, cells); !status) return fail(status.error());
  }
  const Tree& place = *spec.find("cell");
  Tree list{Tree::Array{}, place.file, place.line};
  for (MadeCell& cell : cells) {
    if (cell.repetitions) cell.tree.set("repetitions", Tree{*cell.repetitions, place.file, place.line});
    std::get<Tree::Array>(list.value).items.push_back(std::move(cell.tree));
  }
  Tree out = spec;
  out.erase("factor");
  out.set("cell", std::move(list));
  return out;
}

std::vector<std::pair<std::string, Tree>> values_set_by(const Tree& cell) {
  std::vector<std::pair<std::string, Tree>> out;
  const Tree* set = cell.find("set");
  if (set != nullptr && set->table() != nullptr) flatten(*set, "", out);
  return out;
}

}  // namespace fatmc
