// Tables of a selection: H 4.2 and 4.3.
#include <algorithm>

#include "campaigns/candidates/cell_tables.h"
#include "core/base/text.h"
#include "core/stats/empirical.h"
#include "core/subspace/model_fit.h"

namespace fatmc::candidates {
namespace {

std::uint64_t with_resonance(const JudgedModels& models, const std::vector<std::size_t>& set) {
  return static_cast<std::uint64_t>(std::count_if(set.begin(), set.end(), [&](std::size_t i) {
    return models.of(i) != nullptr && models.of(i)->artifacts > 0;
  }));
}

void add_artifacts(const JudgedModels& models, const Selected& selected, int order, const CellTables& out) {
  const std::string name = "n = " + std::to_string(order);
  const auto row_of = [&](const char* which, const std::vector<std::size_t>& set) {
    const auto judged = models.judged(set);
    TableRow row = out.row("Section 4", name + which, "models with a resonance that the truth does not have",
                           "%", kNone, judged);
    fill_share(row, with_resonance(models, set), judged, std::max<std::uint64_t>(selected.best.size(), 1));
    row.why = models.left_out(set);
    if (judged > 1) row.why += (row.why.empty() ? "" : "; ") + std::string(kRelatedModels);
    return row;
  };
  out.add(row_of(", all", selected.all));
  TableRow by_agreement = row_of(", best by d1", selected.best);
  const double best = by_agreement.value;
  out.add(std::move(by_agreement));
  out.add(row_of(", norm below the limit", selected.accepted));
  if (!selected.best.empty() && models.of(selected.best.front()) != nullptr) {
    TableRow first =
        out.claim("Section 4", name, "resonances of the best model (print: one at least)", "",
                  models.of(selected.best.front())->artifacts, 1, order == kShownOrder ? 1.0 : kNone);
    out.add_claim(std::move(first), first.value > 0.0, "one model: no interval");
  }
  TableRow row = row_of(", candidates", selected.candidates);
  if (selected.candidates.empty()) return out.add_claim(std::move(row), false, kNoModel);
  const bool fewer = best > 0.0 && row.value < 0.5 * best;
  const std::string reason = !(best > 0.0)
                                 ? "the best by d1 have none either: nothing to tell apart"
                                 : "among the best by d1 " + significant(best, 3) +
                                       " % have one; alike: at most half as many among the candidates";
  // An interval that holds 0 for want of models proves nothing where the best by d1 do as well.
  if (!fewer || models.judged(selected.candidates) < 2) return out.add_claim(std::move(row), fewer, reason);
  judge(row, true, reason);
  out.add(std::move(row));
}

void add_pasts(const ModelTable& table, const Selected& selected, int order, const CellTables& out) {
  const std::string name = "n = " + std::to_string(order);
  constexpr double kLow = 250.0, kHigh = 700.0;  // H 4.3
  std::vector<double> past;
  for (const std::size_t i : selected.candidates) past.push_back(table.models[i].past);
  double longest = 0.0;
  for (const ModelRow& model : table.models) longest = std::max(longest, static_cast<double>(model.past));
  const double low = past.empty() ? kNone : *std::min_element(past.begin(), past.end()),
               high = past.empty() ? kNone : *std::max_element(past.begin(), past.end());
  const auto unjudged = [&](TableRow& row) {
    if (longest >= kHigh || std::isnan(row.published)) return false;
    row.why = "no verdict: p ends at " + significant(longest, 4) + " here";
    return true;
  };
  const auto add = [&](const char* quantity, double value) {
    TableRow row = out.row("Section 4", name, quantity, "", value, past.size());
    if (unjudged(row)) return out.add(std::move(row));
    out.add_claim(std::move(row), low >= kLow && high <= kHigh,
                  past.empty() ? kNoModel : "p of the candidates lies between 250 and 700 in print");
  };
  add("smallest p of the candidates", low);
  add("largest p of the candidates", high);
  TableRow row = out.claim("Section 4", name, "candidates with p from 250 to 700", "%", kNone, past.size(),
                           order == kShownOrder ? 100.0 : kNone);
  const auto inside = static_cast<std::uint64_t>(
      std::count_if(past.begin(), past.end(), [&](double p) { return p >= kLow && p <= kHigh; }));
  fill_share(row, inside, past.size(), std::max<std::uint64_t>(selected.best.size(), 1));
  if (unjudged(row)) return out.add(std::move(row));
  if (past.empty()) return out.add_claim(std::move(row), false, kNoModel);
  row.why = kRelatedModels;
  if (past.size() < 2) return out.add_claim(std::move(row), inside > 0, "one candidate alone");
  judge(row, 2 * inside >= past.size(), "alike: at least half of the candidates");
  out.add(std::move(row));
}

double median_of(const ModelTable& table, const std::vector<std::size_t>& set, double ModelRow::*value) {
  std::vector<double> values;
  for (const std::size_t i : set) values.push_back(table.models[i].*value);
  return sample_quantile(values, 0.5);
}

void add_medians(const ModelTable& table, const Selected& selected, const std::string& name,
                 const CellTables& out) {
  const auto& set = selected.candidates;
  if (set.empty()) return;
  out.add(out.row("Section 4", name, "median d1 of the candidates", "",
                  median_of(table, set, &ModelRow::agreement), set.size()));
  TableRow rms = out.row("Section 4", name, "median J_rms of the candidates", "ft/s, deg/s, deg",
                         median_of(table, set, &ModelRow::rms), set.size());
  rms.why = "rated " + std::string(rms_rating(rms.value)) + " by (9)";
  out.add(std::move(rms));
  out.add(out.row("Section 4", name, "median Theil coefficient of the candidates", "",
                  median_of(table, set, &ModelRow::theil), set.size()));
}

}  // namespace

void add_selection_tables(const JudgedModels& models, const Selection& selection, const Selected& selected,
                          const CellTables& out) {
  const std::string name = "n = " + std::to_string(selection.order);
  out.add(out.row("Section 4", name, "limit of the norm", "", selected.limit, selected.all.size()));
  const auto count = [&](const char* quantity, const std::vector<std::size_t>& set) {
    out.add(out.row("Section 4", name, quantity, "", static_cast<double>(set.size()), selected.all.size()));
  };
  count("models with norm below the limit", selected.accepted);
  count("candidates", selected.candidates);
  add_artifacts(models, selected, selection.order, out);
  add_pasts(models.table, selected, selection.order, out);
  add_medians(models.table, selected, name, out);
}

}  // namespace fatmc::candidates
