#include "campaigns/estimators/user_choices_figure.h"

#include <numeric>

#include "campaigns/base/prepared_trials.h"
#include "campaigns/base/spec_path.h"

namespace fatmc::estimators {
namespace {

constexpr std::size_t kIndirect = 3;
static_assert(kEstimators[kIndirect].key == "fast_lpm_indirect");

struct Choice {
  int order = 0, q = 0, periods = 0;
  bool windy = false;
};

double number(const Tree& tree, const char* path) {
  const Tree* value = find_at(tree, path);
  return value != nullptr ? real_value(*value).value_or(0.0) : 0.0;
}

std::optional<Choice> choice_of(const CampaignSpec& spec, std::uint32_t index) {
  const auto cell = spec_of_cell(spec, index);
  if (!cell) return std::nullopt;
  Choice out;
  out.order = static_cast<int>(number(cell->tree, "estimator.order"));
  out.q = 2 * static_cast<int>(number(cell->tree, "estimator.n_e")) + 1 - (out.order + 1);
  out.periods = static_cast<int>(number(cell->tree, "experiment.excitation.periods"));
  out.windy = number(cell->cells.front().tree, "turbulence_sigma_m_s") > 0.0;
  return out;
}

}  // namespace

void UserChoices::add(const CampaignSpec& spec, std::uint32_t index, const CellRuns& cell) {
  const std::vector<double>& errors = cell.of[kIndirect].relative_error;
  const auto choice = choice_of(spec, index);
  if (!choice || errors.empty()) return;
  plot::Line& line = curves_[{choice->windy, choice->order, choice->periods}];
  line.name = "R = " + std::to_string(choice->order) + ", P = " + std::to_string(choice->periods);
  line.x.push_back(choice->q);
  line.y.push_back(100.0 * std::accumulate(errors.begin(), errors.end(), 0.0) /
                   static_cast<double>(errors.size()));
}

std::optional<StudyFigure> UserChoices::figure() const {
  static constexpr std::array kHues = {plot::Hue::blue, plot::Hue::orange, plot::Hue::green,
                                       plot::Hue::purple};
  if (curves_.empty()) return std::nullopt;
  StudyFigure out{"Section 3.5",
                  "rms over the lines of |Ĝ − G0|/|G0| of the fast LPM (indirect), mean over runs, against "
                  "the degrees of "
                  "freedom q of its residuals: without noise the interpolation error alone, which wider "
                  "windows raise; in "
                  "light turbulence the scatter, which wider windows and further periods lower.",
                  {}};
  out.figure.title = "User choices of the fast LPM";
  out.figure.columns = 2;
  for (const bool windy : {false, true}) {
    plot::Panel panel;
    panel.title = windy ? "light turbulence" : "no noise";
    panel.x.label = "degrees of freedom q";
    panel.y = {"error, %", plot::Scale::logarithmic, {}, {}};
    std::size_t place = 0;
    for (const auto& [key, curve] : curves_) {
      if (std::get<0>(key) != windy) continue;
      plot::Line line = curve;
      line.hue = kHues[place++ % kHues.size()];
      panel.marks.emplace_back(plot::Points{line.name, line.x, line.y, line.hue});
      panel.marks.emplace_back(std::move(line));
    }
    out.figure.panels.push_back(std::move(panel));
  }
  return out;
}

}  // namespace fatmc::estimators
