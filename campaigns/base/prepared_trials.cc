#include "campaigns/base/prepared_trials.h"

#include <algorithm>

#include "campaigns/base/cell_grid.h"
#include "campaigns/base/spec_path.h"
#include "core/base/check.h"

namespace fatmc {
namespace {

// Values are set while the cell's own table stands under "cell", so that paths reach it, too.
void take_cell_from_tree(CampaignSpec& spec) { spec.cells.front().tree = *spec.tree.find("cell"); }

Status set_drawn(CampaignSpec& spec, const std::vector<Dispersion>& dispersions,
                 const std::vector<std::vector<double>>& values) {
  for (std::size_t i = 0; i < dispersions.size(); ++i) {
    if (Status status = apply_draw(dispersions[i], values[i], spec.tree); !status) return status;
  }
  take_cell_from_tree(spec);
  return {};
}

// Parameters are drawn anew for each trial, so that nothing can be prepared ahead: what a study prepares
// depends on all of its spec. A trial stays a pure function, and studies know nothing of dispersions.
class DispersedCell final : public PreparedCell {
 public:
  DispersedCell(const TrialStudy& study, CampaignSpec spec, std::vector<Dispersion> dispersions)
      : study_(study), spec_(std::move(spec)), dispersions_(std::move(dispersions)) {}

  /// Whether the middle of the laws can be flown.
  [[nodiscard]] Status check() const {
    std::vector<std::vector<double>> values;
    for (const Dispersion& dispersion : dispersions_) values.push_back(dispersion.typical());
    if (auto prepared = prepare(values); !prepared) return fail(prepared.error());
    return {};
  }

  [[nodiscard]] TrialRow run(std::uint64_t repetition) const override {
    const auto values = draw(repetition);
    const auto prepared = prepare(values);
    TrialRow row;
    if (prepared) {
      row = (*prepared)->run(repetition);
    } else {
      row.outcome = "infeasible";
      // Without the file: a result must not depend on the folder that the spec was read from.
      row.detail = Error{{}, 0, prepared.error().key, prepared.error().message}.text();
    }
    row.key = {0, repetition};
    std::vector<std::pair<std::string, double>> metrics;
    for (std::size_t i = 0; i < dispersions_.size(); ++i) {
      for (std::size_t k = 0; k < values[i].size(); ++k) {
        metrics.emplace_back(std::string(kDrawPrefix) + dispersions_[i].names[k], values[i][k]);
      }
    }
    row.metrics.insert(row.metrics.begin(), metrics.begin(), metrics.end());
    return row;
  }

  [[nodiscard]] std::optional<TrialRecord> record(std::uint64_t repetition) const override {
    const auto prepared = prepare(draw(repetition));
    return prepared ? (*prepared)->record(repetition) : std::nullopt;
  }

 private:
  [[nodiscard]] std::vector<std::vector<double>> draw(std::uint64_t repetition) const {
    const TrialSeed seed = spec_.trial_seed({0, repetition});
    std::vector<std::vector<double>> values;
    for (const Dispersion& dispersion : dispersions_) values.push_back(dispersion.draw(seed));
    return values;
  }

  [[nodiscard]] Result<std::unique_ptr<PreparedCell>> prepare(
      const std::vector<std::vector<double>>& values) const {
    CampaignSpec own = spec_;
    own.tree.set("cell", own.cells.front().tree);
    if (Status status = set_drawn(own, dispersions_, values); !status) return fail(status.error());
    return study_.prepare(own, 0);
  }

  TrialStudy study_;
  CampaignSpec spec_;
  std::vector<Dispersion> dispersions_;
};

// Keeps of each row what the spec wants kept. The flight of a record is flown again: records of all trials
// cost a second flight each, those of failures next to nothing.
class KeepingCell final : public PreparedCell {
 public:
  KeepingCell(std::unique_ptr<PreparedCell> inner, Keep keep) : inner_(std::move(inner)), keep_(keep) {}

  [[nodiscard]] TrialRow run(std::uint64_t repetition) const override {
    TrialRow row = inner_->run(repetition);
    if (!keep_.arrays) row.arrays.clear();
    const bool wanted = keep_.records == Keep::Records::all ||
                        (keep_.records == Keep::Records::failures && row.outcome != "ok");
    if (!wanted) return row;
    if (const std::optional<TrialRecord> flown = inner_->record(repetition)) {
      for (std::size_t i = 0; i < flown->names.size(); ++i) {
        const auto column = flown->columns.col(static_cast<Eigen::Index>(i));
        row.arrays.emplace_back(kRecordPrefix + flown->names[i],
                                std::vector<double>(column.begin(), column.end()));
      }
    }
    return row;
  }

  [[nodiscard]] std::optional<TrialRecord> record(std::uint64_t repetition) const override {
    return inner_->record(repetition);
  }

 private:
  std::unique_ptr<PreparedCell> inner_;
  Keep keep_;
};

// A draw that takes a value's place makes what a cell sets there pointless.
Status check_not_set_twice(const Cell& cell, const std::vector<Dispersion>& dispersions) {
  for (const auto& [path, value] : values_set_by(cell.tree)) {
    for (const Dispersion& dispersion : dispersions) {
      const auto& paths = dispersion.paths;
      if (dispersion.apply != Dispersion::Apply::set ||
          std::find(paths.begin(), paths.end(), path) == paths.end())
        continue;
      return fail(Error{
          value.file, value.line, path,
          "is set here and drawn by a dispersion that takes its place, write apply = \"add\" or \"scale\" "
          "there, or disperse = false in the cell"});
    }
  }
  return {};
}

}  // namespace

Result<CampaignSpec> spec_of_cell(const CampaignSpec& spec, std::uint32_t index) {
  FATMC_CHECK(index < spec.cells.size(), "the cell is beyond the plan");
  CampaignSpec out;
  out.study = spec.study;
  out.name = spec.name;
  out.seed = spec.seed;
  out.tree = spec.tree;
  out.cells = {spec.cells[index]};
  for (const std::string_view own : kEngineTables) out.tree.erase(own);
  Tree cell = spec.cells[index].tree;
  for (const std::string_view own : kEngineCellKeys) cell.erase(own);
  out.tree.set("cell", std::move(cell));
  for (const auto& [path, value] : values_set_by(spec.cells[index].tree)) {
    if (is_of_engine(path))
      return fail(Error{value.file, value.line, "cell.set." + path, "is not for a cell to set"});
    if (Status status = set_at(out.tree, path, value); !status) return fail(status.error());
  }
  take_cell_from_tree(out);
  return out;
}

Result<std::unique_ptr<PreparedCell>> prepare_trials(const TrialStudy& study, const CampaignSpec& spec,
                                                     std::uint32_t index) {
  Result<CampaignSpec> own = spec_of_cell(spec, index);
  if (!own) return fail(own.error());
  const Cell& cell = spec.cells[index];
  std::unique_ptr<PreparedCell> prepared;
  if (spec.dispersions.empty() || !cell.disperse) {
    auto plain = study.prepare(*own, 0);
    if (!plain) return plain;
    prepared = std::move(*plain);
  } else {
    if (Status status = check_not_set_twice(cell, spec.dispersions); !status) return fail(status.error());
    auto dispersed = std::make_unique<DispersedCell>(study, std::move(*own), spec.dispersions);
    if (Status status = dispersed->check(); !status) return fail(status.error());
    prepared = std::move(dispersed);
  }
  if (spec.keep.arrays && spec.keep.records == Keep::Records::none) return prepared;
  return std::make_unique<KeepingCell>(std::move(prepared), spec.keep);
}

}  // namespace fatmc
