#include "coordinator/report/campaign_page.h"

#include <algorithm>
#include <cmath>

#include "coordinator/report/html_page.h"
#include "coordinator/report/html_tables.h"
#include "coordinator/report/table_text.h"
#include "core/base/text.h"
#include "core/stats/empirical.h"
#include "core/stats/intervals.h"

namespace fatmc {
namespace {

std::string id_of(const CampaignPage& campaign) { return html::anchor(campaign.name); }

std::string verdicts(const VerdictCount& count) {
  std::string out;
  for (const auto& [name, n] : {std::pair{"exact", count.exact}, std::pair{"match", count.match},
                                std::pair{"shape", count.shape}, std::pair{"differs", count.differs}}) {
    if (n == 0) continue;
    out += (out.empty() ? "" : ", ") + std::to_string(n) + " <span class=\"verdict " + name + "\">" + name +
           "</span>";
  }
  return out;
}

std::string contents(const std::vector<CampaignPage>& campaigns) {
  std::vector<std::vector<std::string>> rows;
  for (const CampaignPage& campaign : campaigns) {
    std::string what;
    std::vector<std::string> seen;
    for (const TableRow& row : campaign.rows) {
      if (std::find(seen.begin(), seen.end(), row.table) != seen.end()) continue;
      seen.push_back(row.table);
      what += (what.empty() ? "" : ", ") + std::string("<a href=\"#") + id_of(campaign) + "-table-" +
              html::anchor(row.table) + "\">" + html::text(table_heading(row.table)) + "</a>";
    }
    rows.push_back({"<a href=\"#" + id_of(campaign) + "\">" + html::text(campaign.title) + "</a>", what,
                    campaign.planned > 0 ? std::to_string(campaign.stored) : "-",
                    std::to_string(campaign.figures.size()), verdicts(count_verdicts(campaign.rows))});
  }
  return "<nav>" +
         html::table({{"campaign"}, {"tables"}, {"trials", true}, {"figures", true}, {"verdicts"}}, rows) +
         "</nav>\n";
}

std::string cell_section(const CampaignPage& campaign, const CellPage& cell) {
  std::string out = "<h3 id=\"" + id_of(campaign) + "-cell-" + html::anchor(cell.name) + "\">Cell " +
                    html::text(cell.name) + "</h3>\n<p>";
  std::uint64_t stored = 0;
  std::string outcomes;
  for (const auto& [name, trials] : cell.outcomes) {
    stored += trials;
    outcomes += ", " + std::to_string(trials) + " " + html::text(name);
  }
  out += std::to_string(stored) + " of " + std::to_string(cell.planned) + " trials" + outcomes + ".";
  for (const auto& [path, value] : cell.settings)
    out += " <code>" + html::text(path) + " = " + html::text(value) + "</code>";
  out += "</p>\n";
  if (cell.scalars.empty()) return out;
  std::vector<std::vector<std::string>> rows;
  for (const ScalarSummary& s : cell.scalars) {
    rows.push_back({html::text(s.name), std::to_string(s.n)});
    for (const double value :
         {s.mean, s.deviation, s.lowest, s.lower_quartile, s.median, s.upper_quartile, s.highest})
      rows.back().push_back(significant(value, 4));
  }
  return out + html::table({{"scalar"},
                            {"n", true},
                            {"mean", true},
                            {"deviation", true},
                            {"lowest", true},
                            {"25 %", true},
                            {"median", true},
                            {"75 %", true},
                            {"highest", true}},
                           rows);
}

std::string section(const CampaignPage& campaign) {
  std::string out = "<section><h2 id=\"" + id_of(campaign) + "\">" + html::text(campaign.title) + "</h2>\n";
  if (campaign.stored < campaign.planned) {
    out += "<p class=\"partial\">Partial: " + std::to_string(campaign.stored) + " of " +
           std::to_string(campaign.planned) +
           " trials are stored; every table and figure below is of these alone.</p>\n";
  }
  if (!campaign.figures.empty()) out += "<div class=\"figures\">\n";
  for (const StudyFigure& figure : campaign.figures)
    out += html::figure(figure.figure, figure_name(campaign, figure), figure.id, figure.caption);
  if (!campaign.figures.empty()) out += "</div>\n";
  out += html_tables(campaign.rows, id_of(campaign));
  for (const CellPage& cell : campaign.cells) out += cell_section(campaign, cell);
  return out + "</section>\n";
}

std::string provenance(const std::vector<CampaignPage>& campaigns) {
  std::string out = "<footer><h2 id=\"provenance\">Provenance</h2>\n";
  for (const CampaignPage& campaign : campaigns) {
    if (campaign.provenance.empty()) continue;
    std::vector<std::vector<std::string>> rows;
    for (const auto& [what, value] : campaign.provenance)
      rows.push_back({html::text(what), "<code>" + html::text(value) + "</code>"});
    out += "<h3>" + html::text(campaign.name) + "</h3>\n" + html::table({{"what"}, {"value"}}, rows);
  }
  return out + "</footer>\n";
}

}  // namespace

CellPage summarise_cell(const std::string& name, std::uint64_t planned, std::uint32_t cell,
                        const RowSource& rows) {
  CellPage out;
  out.name = name;
  out.planned = planned;
  std::vector<std::pair<std::string, std::vector<double>>> values;
  rows(cell, [&](const TrialRow& row) {
    const auto same = [&](const auto& known) { return known.first == row.outcome; };
    auto outcome = std::find_if(out.outcomes.begin(), out.outcomes.end(), same);
    if (outcome == out.outcomes.end()) outcome = out.outcomes.insert(outcome, {row.outcome, 0});
    ++outcome->second;
    for (std::size_t i = 0; i < row.metrics.size(); ++i) {
      const auto& [scalar, value] = row.metrics[i];
      // Rows of a study list their scalars in one order: the place is nearly always the same.
      auto place =
          i < values.size() && values[i].first == scalar
              ? values.begin() + static_cast<std::ptrdiff_t>(i)
              : std::find_if(values.begin(), values.end(), [&](const auto& v) { return v.first == scalar; });
      if (place == values.end()) place = values.insert(place, {scalar, {}});
      if (std::isfinite(value)) place->second.push_back(value);
    }
  });
  for (auto& [scalar, list] : values) {
    if (list.empty()) continue;
    const RunMean mean = mean_over_runs(list);
    const EmpiricalCdf sample(std::move(list));
    out.scalars.push_back({scalar, mean.n, mean.mean, mean.deviation, sample.quantile(0.0),
                           sample.quantile(0.25), sample.quantile(0.5), sample.quantile(0.75),
                           sample.quantile(1.0)});
  }
  return out;
}

std::string figure_name(const CampaignPage& campaign, const StudyFigure& figure) {
  return html::anchor(campaign.name) + "-" + html::anchor(figure.id);
}

std::string campaign_page(const std::string& title, const std::vector<CampaignPage>& campaigns) {
  std::string body =
      "<header><h1>" + html::text(title) + "</h1>\n" +
      "<p><span class=\"verdict exact\">exact</span>: a formula's value has the printed digits. "
      "<span class=\"verdict match\">match</span>: the published value lies in the 95 % prediction "
      "interval for a campaign of the published size. <span class=\"verdict shape\">shape</span>: same "
      "sign and order (half a decade; decibels within 10). <span class=\"verdict differs\">differs</span>: "
      "neither. Reasons stand below each "
      "table. Intervals come from the scatter between runs.</p>\n" +
      contents(campaigns) + "</header>\n<main>\n";
  for (const CampaignPage& campaign : campaigns) body += section(campaign);
  return html::page(title, body + "</main>\n" + provenance(campaigns));
}

}  // namespace fatmc
