#include "campaigns/estimators/summary.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "campaigns/base/verdict.h"
#include "campaigns/estimators/cell_runs.h"
#include "campaigns/estimators/mean_error.h"
#include "campaigns/estimators/reasons.h"
#include "core/base/text.h"

namespace fatmc::estimators {
namespace {

constexpr std::array kTabulatedHz = {0.2, 0.4, 0.6, 0.8, 1.0};  // of Tables 3-2 and 3-3

std::optional<std::size_t> line_at(const CellRuns& cell, double frequency_hz) {
  for (std::size_t k = 0; k < cell.frequency_hz.size(); ++k) {
    if (std::abs(cell.frequency_hz[k] - frequency_hz) < 1e-9) return k;
  }
  return std::nullopt;
}

const PublishedFigure* printed_for(const std::vector<PublishedFigure>& published, TableRow& row) {
  const PublishedFigure* figure = find_published(published, row.table, row.row, row.quantity);
  if (figure != nullptr) row.published = figure->value;
  return figure;
}

void judge_as_printed(const PublishedFigure* figure, TableRow& row) {
  if (figure == nullptr) return;
  if (figure->upper_bound) return judge_upper_bound(row, reason_for(row));
  judge_by_order(row, reason_for(row));
}

/// A row of Table 3-2 (|mean|) or 3-3 (range of the mean), over the runs of one estimator at one line.
void add_error_row(const char* table, const CellRuns& cell, std::size_t estimator, double frequency_hz,
                   const std::vector<PublishedFigure>& published, std::vector<TableRow>& out) {
  const auto line = line_at(cell, frequency_hz);
  if (!line) return;
  const EstimatorRuns& runs = cell.of[estimator];
  TableRow row = table_row(table, cell.row_name(estimator), shortest(frequency_hz) + " Hz", "dB");
  row.why = cell.failures();
  const std::vector<double> errors = runs.magnitude_errors_db(*line);
  const ErrorOfRun error = [&](std::size_t run) { return errors[run]; };
  const bool mean = std::string_view(table) == "3-2";
  fill_statistic(row, runs.error.size(), kPublishedRepetitions, [&](std::span<const std::size_t> picks) {
    return mean ? std::abs(mean_of(picks, error).mean) : range_of_mean(picks, error, kPublishedRepetitions);
  });
  row.low = std::max(row.low, 0.0);
  judge_as_printed(printed_for(published, row), row);
  out.push_back(std::move(row));
}

void add_error_tables(const CellRuns& cell, const std::vector<PublishedFigure>& published,
                      std::vector<TableRow>& means, std::vector<TableRow>& ranges) {
  for (std::size_t e = 0; e < kEstimators.size(); ++e) {
    for (const double f : kTabulatedHz) {
      if (cell.shown_in("3-2")) add_error_row("3-2", cell, e, f, published, means);
      if (cell.shown_in("3-3")) add_error_row("3-3", cell, e, f, published, ranges);
    }
  }
}

/// Of every campaign of 20 runs (runs 0-19, 20-39, ...), the share of lines whose interval of the mean holds the truth.
std::vector<double> inlier_shares(const EstimatorRuns& runs, std::size_t lines) {
  std::vector<double> out;
  for (std::size_t first = 0; first + kPublishedRepetitions <= runs.error.size();
       first += kPublishedRepetitions) {
    std::vector<std::size_t> picks(kPublishedRepetitions);
    std::iota(picks.begin(), picks.end(), first);
    double hits = 0.0;
    for (std::size_t k = 0; k < lines; ++k)
      hits += interval_holds_zero(picks, [&](std::size_t run) { return runs.magnitude_error(run, k); }) ? 1.0
                                                                                                        : 0.0;
    out.push_back(hits / static_cast<double>(lines));
  }
  return out;
}

void keep_percent(TableRow& row) {
  row.low = std::max(row.low, 0.0);
  row.high = std::min(row.high, 100.0);
}

void add_share(const char* table, const std::string& row_name, const std::string& quantity,
               const std::vector<double>& shares, std::size_t published_runs, std::uint64_t n,
               const std::string& why, const std::vector<PublishedFigure>& published,
               std::vector<TableRow>& out) {
  TableRow row = table_row(table, row_name, quantity, "%");
  row.why = why;
  fill_mean(row, shares, published_runs, 100.0);
  keep_percent(row);
  row.n = n;
  judge_as_printed(printed_for(published, row), row);
  out.push_back(std::move(row));
}

void add_section_3_4_1(const CellRuns& cell, const std::vector<PublishedFigure>& published,
                       std::vector<TableRow>& out) {
  if (!cell.shown_in("Section 3.4.1")) return;
  for (std::size_t e = 0; e < kEstimators.size(); ++e) {
    const EstimatorRuns& runs = cell.of[e];
    // One value a campaign of 20: print is one such campaign.
    add_share("Section 3.4.1", cell.row_name(e),
              "lines whose 90 % interval of the mean of 20 holds the truth",
              inlier_shares(runs, cell.frequency_hz.size()), 1, cell.trials, cell.failures(), published, out);
    add_share("Section 3.4.1", cell.row_name(e), "lines whose own 90 % region holds the truth",
              runs.inside_90, kPublishedRepetitions, cell.trials, cell.failures(), published, out);
    add_share("Section 3.4.1", cell.row_name(e), "lines inside the MUAD limits", runs.unnoticed,
              kPublishedRepetitions, cell.trials, cell.failures(), published, out);
  }
}

/// The lowest lines, where the fast LPM is biased.
void add_section_3_4_2(const CellRuns& cell, const std::vector<PublishedFigure>& published,
                       std::vector<TableRow>& out) {
  constexpr double kHighestHz = 0.15 + 1e-9;
  if (!cell.shown_in("Section 3.4.2")) return;
  const auto lines = static_cast<std::size_t>(std::count_if(
      cell.frequency_hz.begin(), cell.frequency_hz.end(), [](double f) { return f <= kHighestHz; }));
  for (std::size_t e = 0; e < kEstimators.size(); ++e) {
    const EstimatorRuns& runs = cell.of[e];
    TableRow row = table_row("Section 3.4.2", cell.row_name(e),
                             "largest mean error of the magnitude, 0.05 to 0.15 Hz", "%");
    row.why = cell.failures();
    std::vector<std::vector<double>> errors;
    for (std::size_t k = 0; k < lines; ++k) errors.push_back(runs.magnitude_errors(k));
    fill_statistic(row, runs.error.size(), kPublishedRepetitions, [&](std::span<const std::size_t> picks) {
      double largest = 0.0;
      for (const std::vector<double>& of_line : errors) {
        const double mean = mean_of(picks, [&](std::size_t run) { return of_line[run]; }).mean;
        largest = std::max(largest, std::abs(mean));
      }
      return 100.0 * largest;
    });
    row.low = std::max(row.low, 0.0);
    judge_as_printed(printed_for(published, row), row);
    out.push_back(std::move(row));
  }
}

void add_overview(const CellRuns& cell, const std::vector<PublishedFigure>& published,
                  std::vector<TableRow>& out) {
  const std::string name = cell.name.empty() ? "linear" : cell.name;
  for (std::size_t e = 0; e < kEstimators.size(); ++e) {
    const EstimatorRuns& runs = cell.of[e];
    const std::string label(kEstimators[e].label);
    TableRow row = table_row("Section 3.4", name, label + ", rms of |error|/|G0| over the lines", "%");
    row.why = cell.failures();
    fill_mean(row, runs.relative_error, kPublishedRepetitions, 100.0);
    out.push_back(row);
    TableRow cost = table_row("Section 3.4", name, label + ", cost (3.9)", "");
    cost.why = cell.failures();
    fill_mean(cost, runs.cost, kPublishedRepetitions);
    out.push_back(std::move(cost));
    add_share("Section 3.4", name, label + ", lines inside the MUAD limits", runs.unnoticed,
              kPublishedRepetitions, cell.trials, cell.failures(), published, out);
    add_share("Section 3.4", name, label + ", lines whose own 90 % region holds the truth", runs.inside_90,
              kPublishedRepetitions, cell.trials, cell.failures(), published, out);
  }
}

/// Section 3.5: what a choice of P, R and q does to the fast LPM (indirect, as everywhere but in 3.4), beside the transient LPM.
void add_user_choices(const CellRuns& cell, std::vector<TableRow>& out) {
  for (const std::size_t e : {std::size_t{1}, std::size_t{3}}) {
    const EstimatorRuns& runs = cell.of[e];
    const std::string label(kEstimators[e].label);
    TableRow error = table_row("Section 3.5", cell.name, label + ", rms of |error|/|G0| over the lines", "%");
    error.why = cell.failures();
    fill_mean(error, runs.relative_error, kPublishedRepetitions, 100.0);
    out.push_back(std::move(error));
    if (e == 1) continue;
    add_share("Section 3.5", cell.name, label + ", lines whose own 90 % region holds the truth",
              runs.inside_90, kPublishedRepetitions, cell.trials, cell.failures(), {}, out);
  }
}

}  // namespace

Result<std::vector<TableRow>> tables(const CampaignSpec& spec, const RowSource& rows) {
  auto published = decode_published(spec);
  if (!published) return fail(published.error());
  std::vector<TableRow> means, ranges, linear, nonlinear, overview;
  for (std::uint32_t index = 0; index < spec.cells.size(); ++index) {
    const auto gathered = collect_cell(spec, index, rows);
    if (!gathered) return fail(gathered.error());
    const CellRuns& cell = *gathered;
    if (cell.trials == cell.failed) continue;
    const std::vector<PublishedFigure> figures =
        compared_with_print(spec, index) ? *published : std::vector<PublishedFigure>{};
    add_error_tables(cell, figures, means, ranges);
    add_section_3_4_1(cell, figures, linear);
    add_section_3_4_2(cell, figures, nonlinear);
    cell.shown_in("Section 3.5") ? add_user_choices(cell, overview) : add_overview(cell, figures, overview);
  }
  std::vector<TableRow> out;
  for (const auto* part : {&means, &ranges, &linear, &nonlinear, &overview})
    out.insert(out.end(), part->begin(), part->end());
  return out;
}

const SummaryStudy kSummaryStudy{"estimators", &tables, &figures};

}  // namespace fatmc::estimators
