#include "coordinator/report/campaign_page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "coordinator/report/html_page.h"
#include "coordinator/report/html_tables.h"

namespace fatmc {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

const std::vector<TableRow> kRows = {
    {"5-5", "95 %", "a < b", "%", 94.5, 95.25, 94.0, 95.5, 50, "match", ""},
    {"5-5", "95 %", "joint", "%", 90.0, 98.0, 97.0, 99.0, 50, "differs", "too \"wide\""},
    {"Fig. 5-4", "x = 1", "q", "", std::nan(""), 1.0, std::nan(""), std::nan(""), 50, "", ""}};

CampaignPage campaign() {
  CampaignPage out;
  out.name = out.title = "Cover & age";
  out.stored = out.planned = 2;
  out.rows = kRows;
  StudyFigure figure{"Fig. 5-4", "Caption <1>", {}};
  figure.figure.panels.resize(1);
  figure.figure.panels[0].marks = {plot::Line{"ours", {1.0, 2.0}, {3.0, 4.0}}};
  out.figures = {figure};
  out.provenance = {{"database", "a.db"}};
  return out;
}

TEST(CampaignPage, IsWholeInItself) {
  const std::string page = campaign_page("T & U", {campaign()});
  EXPECT_THAT(page, HasSubstr("<title>T &amp; U</title>"));
  EXPECT_THAT(page, HasSubstr("a &lt; b"));
  EXPECT_THAT(page, HasSubstr("too &quot;wide&quot;"));
  EXPECT_THAT(page, HasSubstr("Caption &lt;1&gt;"));
  for (const char* outside : {"http://", "https://", "<script", "src=", "@import"}) {
    std::string rest = page;
    for (std::size_t at; (at = rest.find("http://www.w3.org/2000/svg")) != std::string::npos;)
      rest.erase(at, 26);
    EXPECT_THAT(rest, Not(HasSubstr(outside)));
  }
}

TEST(CampaignPage, LinksEveryTableToItsPlace) {
  const std::string page = campaign_page("T", {campaign()});
  for (const char* id : {"cover-age", "cover-age-table-5-5", "cover-age-table-fig-5-4"})
    EXPECT_THAT(page, HasSubstr("href=\"#" + std::string(id) + "\""));
  EXPECT_THAT(page, HasSubstr("<h2 id=\"cover-age\">"));
  EXPECT_THAT(page, HasSubstr("<h3 id=\"cover-age-table-5-5\">Table 5-5</h3>"));
}

TEST(CampaignPage, SaysOfAPartialCampaignThatItIsPartial) {
  CampaignPage partial = campaign();
  partial.planned = 3;
  EXPECT_THAT(campaign_page("T", {campaign()}), Not(HasSubstr("Partial:")));
  EXPECT_THAT(campaign_page("T", {partial}), HasSubstr("Partial: 2 of 3 trials are stored"));
}

TEST(Verdicts, AreCountedByName) {
  const VerdictCount count = count_verdicts(kRows);
  EXPECT_EQ(count.match, 1U);
  EXPECT_EQ(count.differs, 1U);
  EXPECT_EQ(count.total(), 2U);
}

TEST(CellSummary, CountsOutcomesAndOrdersScalars) {
  const std::vector<TrialRow> rows = {{{0, 0}, "ok", "", {{"a", 1.0}, {"b", 5.0}}, {}},
                                      {{0, 1}, "diverged", "", {{"b", 7.0}}, {}},
                                      {{0, 2}, "ok", "", {{"a", 3.0}, {"b", std::nan("")}}, {}}};
  const CellPage cell = summarise_cell("c", 5, 0, [&](std::uint32_t, const auto& visit) {
    for (const TrialRow& row : rows) visit(row);
  });
  EXPECT_THAT(cell.outcomes, ElementsAre(std::pair<std::string, std::uint64_t>{"ok", 2},
                                         std::pair<std::string, std::uint64_t>{"diverged", 1}));
  ASSERT_EQ(cell.scalars.size(), 2U);
  EXPECT_EQ(cell.scalars[0].name, "a");
  EXPECT_DOUBLE_EQ(cell.scalars[0].mean, 2.0);
  EXPECT_DOUBLE_EQ(cell.scalars[0].deviation, std::sqrt(2.0));
  EXPECT_EQ(cell.scalars[1].n, 2U);
  EXPECT_DOUBLE_EQ(cell.scalars[1].median, 6.0);
}

TEST(Anchor, IsAPlainName) {
  EXPECT_EQ(html::anchor("Fig. 5-4 (a)"), "fig-5-4-a");
  EXPECT_EQ(html::anchor("5-5"), "5-5");
}

}  // namespace
}  // namespace fatmc
