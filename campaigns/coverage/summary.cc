#include "campaigns/coverage/summary.h"

#include <algorithm>
#include <utility>

#include "campaigns/base/verdict.h"
#include "campaigns/coverage/covered_runs.h"
#include "campaigns/coverage/insensitivity.h"
#include "core/base/check.h"
#include "core/base/text.h"
#include "core/stats/confidence.h"

namespace fatmc::coverage {
namespace {

TableRow percent_row(const std::string& table, const std::string& row, const std::string& quantity,
                     const std::vector<double>& shares, std::uint64_t n) {
  TableRow out = table_row(table, row, quantity, "%");
  fill_mean(out, shares, kPublishedRepetitions, 100.0);
  clamp_interval(out, 0.0, 100.0);
  out.n = n;
  return out;
}

std::string level_text(double level) { return significant(100.0 * level, 4) + " %"; }

// Why ours and print differ, found by experiment: campaigns/coverage/README.md.
std::string reason_for(Region region) {
  switch (region) {
    case Region::extended:
    case Region::extended_printed_constant:
      return "max(0, |e| - b) only adds to the region without bias, the printed rule also takes away";
    case Region::extended_as_printed:
    case Region::printed_constant_as_printed:
      return "no reading of b gives the four printed shares at once: campaigns/coverage/README.md";
    case Region::plain:
    case Region::sample:
      return "windows of up to 1.3 Hz on this grid and gusts that move all lines of a run together";
  }
  FATMC_CHECK(false, "not a region");
}

void add_table_5_5(const CoveredRuns& cell, const std::string& suffix,
                   const std::vector<PublishedFigure>& published, std::vector<TableRow>& out) {
  using enum CoveredRuns::Scope;
  static constexpr std::array kScopes = {std::pair{element, ""}, std::pair{joint, ", all elements of a line"},
                                         std::pair{bonferroni, ", all elements of a line, Bonferroni"}};
  for (std::size_t level = 0; level < kLevels.size(); ++level) {
    for (const Region region : kRegions) {
      for (const auto& [scope, scope_name] : kScopes) {
        const auto shares = cell.shares.find({region, level, scope});
        if (shares == cell.shares.end()) continue;
        // The joint rows of every variant would drown the table: those of the two regions in use suffice.
        if (scope != element && region != Region::plain && region != Region::extended) continue;
        TableRow row =
            percent_row("5-5", level_text(kLevels[level]) + suffix,
                        std::string(region_name(region)) + scope_name, shares->second, cell.trials);
        const bool extended = region != Region::plain && region != Region::sample;
        if (scope == element && region != Region::plain) {
          const PublishedFigure* figure = find_published(published, "5-5", level_text(kLevels[level]),
                                                         extended ? "extended region" : "sample error");
          if (figure != nullptr) row.published = figure->value;
        }
        if (cell.failed > 0)
          row.why = std::to_string(cell.failed) + " trials without an estimate count as outside";
        judge_by_side(row, 100.0 * kLevels[level], reason_for(region));
        out.push_back(std::move(row));
      }
    }
  }
}

void add_figure_5_4(const CoveredRuns& cell, const std::string& suffix, std::vector<TableRow>& out) {
  const int q = cell.degrees_of_freedom;
  for (std::size_t x = 0; x < kCdfAbscissae.size(); ++x) {
    for (const Region region : kRegions) {
      const auto shares = cell.cdf.find({region, x});
      if (shares == cell.cdf.end()) continue;
      out.push_back(percent_row("Fig. 5-4", "x = " + significant(kCdfAbscissae[x], 3) + suffix,
                                std::string(region_name(region)), shares->second, cell.trials));
    }
    TableRow law = table_row("Fig. 5-4", "x = " + significant(kCdfAbscissae[x], 3) + suffix,
                             "F(2, " + std::to_string(2 * q) + ")", "%");
    law.value = 100.0 * f_cdf_2_2q(kCdfAbscissae[x], q);
    out.push_back(std::move(law));
  }
}

}  // namespace

Result<std::vector<TableRow>> tables(const CampaignSpec& spec, const RowSource& rows) {
  auto published = decode_published(spec);
  if (!published) return fail(published.error());
  std::vector<TableRow> table_5_5, figure_5_4, snr, figure_5_2;
  for (std::uint32_t index = 0; index < spec.cells.size(); ++index) {
    const CoveredRuns cell = covered_runs(index, rows);
    if (cell.trials == cell.failed) continue;
    const std::string suffix = spec.cells.size() == 1 ? "" : ", " + spec.cells[index].name;
    const std::vector<PublishedFigure> figures =
        compared_with_print(spec, index) ? *published : std::vector<PublishedFigure>{};
    add_table_5_5(cell, suffix, figures, table_5_5);
    add_figure_5_4(cell, suffix, figure_5_4);
    cell.snr.add_rows(cell.trials, suffix, figures, snr);
    if (index == 0) {
      if (Status status = add_insensitivity_rows(spec, figures, figure_5_2); !status)
        return fail(status.error());
    }
  }
  std::vector<TableRow> out = std::move(table_5_5);
  out.insert(out.end(), figure_5_4.begin(), figure_5_4.end());
  out.insert(out.end(), snr.begin(), snr.end());
  out.insert(out.end(), figure_5_2.begin(), figure_5_2.end());
  return out;
}

const SummaryStudy kSummaryStudy{"coverage", &tables, &figures};

}  // namespace fatmc::coverage
