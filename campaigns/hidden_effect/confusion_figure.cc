#include <algorithm>
#include <set>

#include "campaigns/hidden_effect/figures.h"
#include "core/flight/effects/effect.h"

namespace fatmc::hidden_effect {
namespace {

/// Columns beyond the ids.
constexpr const char* kOtherChoice = "other axis or surface";

std::string id_of(int number) {
  static const std::vector<Effect> all = effect_variants();
  return number >= 0 && number < static_cast<int>(all.size()) ? all[static_cast<std::size_t>(number)].id
                                                              : effect_name(number);
}

/// Ids among `wanted`, in the order of the library, then the rest.
std::vector<std::string> ordered(const std::set<std::string>& wanted) {
  std::vector<std::string> out;
  for (const EffectKind& kind : effect_library()) {
    if (wanted.contains(std::string(kind.id))) out.emplace_back(kind.id);
  }
  for (const char* last : {kOtherChoice, "class", "unknown", "nothing", "no answer"}) {
    if (wanted.contains(last)) out.emplace_back(last);
  }
  return out;
}

std::vector<double> whole_numbers(std::size_t count) {
  std::vector<double> out;
  for (std::size_t i = 0; i < count; ++i) out.push_back(static_cast<double>(i));
  return out;
}

plot::Axis names_axis(const std::string& label, const std::vector<std::string>& names) {
  const auto count = static_cast<double>(names.size());
  return {label, plot::Scale::linear, plot::Range{-0.5, count - 0.5}, whole_numbers(names.size()), names};
}

}  // namespace

StudyFigure confusion_figure(const CellResults& cell) {
  // Of an effect that no candidate is, "unknown" is the right answer.
  const bool no_candidate = cell.tier.role == Role::unknown;
  std::map<std::pair<std::string, std::string>, std::uint64_t> counts;
  std::map<std::string, std::uint64_t> totals;
  std::set<std::string> hidden_ids, answers;
  for (const auto& [pair, n] : cell.confusion) {
    const std::string hidden = id_of(pair.first);
    std::string answer = id_of(pair.second);
    if (answer == hidden && pair.first != pair.second) answer = kOtherChoice;
    counts[{hidden, answer}] += n;
    totals[hidden] += n;
    hidden_ids.insert(hidden);
    if (!no_candidate) answers.insert(hidden);  // a column of its own, so that the diagonal is one
    answers.insert(answer);
  }
  std::vector<std::string> rows = ordered(hidden_ids);
  std::reverse(rows.begin(), rows.end());  // the first on top
  const std::vector<std::string> columns = ordered(answers);
  plot::Cells right{no_candidate ? "right answer: unknown" : "right name", {}, {}, {}, plot::Hue::green},
      wrong{"anything else", {}, {}, {}, plot::Hue::orange};
  for (std::size_t r = 0; r < rows.size(); ++r) {
    for (std::size_t c = 0; c < columns.size(); ++c) {
      const auto at = counts.find({rows[r], columns[c]});
      if (at == counts.end()) continue;
      plot::Cells& into = columns[c] == (no_candidate ? "unknown" : rows[r]) ? right : wrong;
      into.x.push_back(static_cast<double>(c));
      into.y.push_back(static_cast<double>(r));
      into.share.push_back(static_cast<double>(at->second) / static_cast<double>(totals.at(rows[r])));
    }
  }
  plot::Panel panel;
  panel.x = names_axis("answered", columns);
  panel.y = names_axis("hidden", rows);
  panel.marks = {std::move(right), std::move(wrong)};
  plot::Figure figure;
  figure.title = "Hidden and answered, " + cell.name;
  figure.panel_width = 240.0 + 19.0 * static_cast<double>(columns.size());
  figure.panel_height = 210.0 + 17.0 * static_cast<double>(rows.size());
  figure.panels = {std::move(panel)};
  return {"Confusion matrix, " + cell.name,
          "Shares of the trials of a row, by depth of colour, in % where they are 1 % and more; " +
              std::to_string(cell.trials()) +
              " trials. Effects by id: "
              "a right id with another axis or surface is an answer of its own.",
          std::move(figure)};
}

}  // namespace fatmc::hidden_effect
