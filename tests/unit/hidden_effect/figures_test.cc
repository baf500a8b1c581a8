#include "campaigns/hidden_effect/figures.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/flight/effects/effect.h"

namespace fatmc::hidden_effect {
namespace {

/// Place of the first variant of that id, and of the one after it.
int place(std::string_view id) {
  const std::vector<Effect> all = effect_variants();
  const auto at = std::find_if(all.begin(), all.end(), [&](const Effect& e) { return e.id == id; });
  return static_cast<int>(at - all.begin());
}

const plot::Cells& cells(const StudyFigure& figure, const std::string& name) {
  for (const plot::Mark& mark : figure.figure.panels.front().marks) {
    const auto* found = std::get_if<plot::Cells>(&mark);
    if (found != nullptr && found->name == name) return *found;
  }
  ADD_FAILURE() << "no cells " << name;
  static const plot::Cells none;
  return none;
}

TEST(ConfusionFigure, HasRightNamesOnItsDiagonalAndEveryRowSumsToOne) {
  CellResults cell;
  cell.name = "one";
  const int delay = place("transport_delay"), mass = place("mass"), inertia = place("inertia");
  cell.confusion = {{{delay, delay}, 7}, {{delay, mass}, 2},      {{delay, CellResults::kUnknown}, 1},
                    {{mass, mass}, 4},   {{inertia, inertia}, 1}, {{inertia, inertia + 1}, 3}};
  const StudyFigure figure = confusion_figure(cell);
  const plot::Panel& panel = figure.figure.panels.front();
  EXPECT_EQ(panel.y.tick_labels, (std::vector<std::string>{"inertia", "mass", "transport_delay"}))
      << "the first on top";
  EXPECT_EQ(panel.x.tick_labels, (std::vector<std::string>{"transport_delay", "mass", "inertia",
                                                           "other axis or surface", "unknown"}));
  const plot::Cells& right = cells(figure, "right name");
  const plot::Cells& wrong = cells(figure, "anything else");
  ASSERT_EQ(right.share.size(), 3u);
  std::vector<double> sums(3, 0.0);
  for (const plot::Cells* part : {&right, &wrong}) {
    for (std::size_t k = 0; k < part->share.size(); ++k)
      sums[static_cast<std::size_t>(part->y[k])] += part->share[k];
  }
  for (const double sum : sums) EXPECT_NEAR(sum, 1.0, 1e-12);
  for (std::size_t k = 0; k < right.x.size(); ++k) EXPECT_EQ(right.x[k], 2.0 - right.y[k]);
  // An inertia of another axis is no right name.
  EXPECT_NEAR(*std::min_element(right.share.begin(), right.share.end()), 0.25, 1e-12);
}

TEST(ConfusionFigure, OfEffectsWithoutACandidateUnknownIsTheRightAnswer) {
  CellResults cell;
  cell.name = "out";
  cell.tier.role = Role::unknown;
  const int delay = place("transport_delay"), mass = place("mass");
  cell.confusion = {{{delay, CellResults::kUnknown}, 3}, {{delay, mass}, 1}};
  const StudyFigure figure = confusion_figure(cell);
  EXPECT_EQ(figure.figure.panels.front().x.tick_labels, (std::vector<std::string>{"mass", "unknown"}));
  EXPECT_EQ(cells(figure, "right answer: unknown").share, std::vector<double>{0.75});
  EXPECT_EQ(cells(figure, "anything else").share, std::vector<double>{0.25});
}

}  // namespace
}  // namespace fatmc::hidden_effect
