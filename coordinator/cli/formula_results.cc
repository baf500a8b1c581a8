#include "coordinator/cli/formula_results.h"

#include <optional>
#include <utility>

#include "campaigns/base/aircraft_model.h"
#include "campaigns/formulas/aircraft_formulas.h"
#include "campaigns/formulas/formula_figures.h"
#include "campaigns/formulas/formula_tables.h"
#include "coordinator/input/toml_file.h"

namespace fatmc::cli {
namespace {

std::optional<AircraftModel> shipped_fat() {
  const auto tree = read_toml("campaigns/models/fat.toml");
  if (!tree) return std::nullopt;
  auto model = decode_aircraft_model(*tree);
  if (!model || model->aircraft.name != "FAT") return std::nullopt;
  return std::move(*model);
}

template <typename Item>
void append(std::vector<Item>& all, Result<std::vector<Item>> more) {
  if (!more) return;
  for (Item& item : *more) all.push_back(std::move(item));
}

}  // namespace

std::vector<TableRow> tables_without_database() {
  std::vector<TableRow> out = formula_tables();
  if (const auto fat = shipped_fat()) append(out, aircraft_tables(*fat));
  return out;
}

std::vector<StudyFigure> figures_without_database() {
  std::vector<StudyFigure> out = formula_figures();
  if (const auto fat = shipped_fat()) append(out, aircraft_figures(*fat));
  return out;
}

}  // namespace fatmc::cli
