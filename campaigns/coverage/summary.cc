#include "campaigns/coverage/summary.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "campaigns/base/verdict.h"
#include "campaigns/coverage/regions.h"
#include "campaigns/coverage/row_arrays.h"
#include "campaigns/coverage/snr_summary.h"
#include "core/base/check.h"
#include "core/base/text.h"
#include "core/stats/confidence.h"

namespace fatmc::coverage {
namespace {

// Abscissae of Fig. 5-4, whose axis ends near 6.
constexpr std::array kCdfAbscissae = {0.25, 0.5, 1.0, 1.5, 2.0, 3.0, 4.0, 6.0};

const std::vector<double>& need(const TrialRow& row, std::string_view name) {
  const std::vector<double>* values = row.array(name);
  FATMC_CHECK(values != nullptr, "a coverage row holds all its arrays");
  return *values;
}

double metric(const TrialRow& row, std::string_view name) {
  for (const auto& [key, value] : row.metrics) {
    if (key == name) return value;
  }
  FATMC_CHECK(false, "a coverage row holds all its metrics");
}

TrialErrors read_errors(const TrialRow& row) {
  const auto& re = need(row, kErrorReal);
  const auto& im = need(row, kErrorImag);
  TrialErrors out;
  out.error.reserve(re.size());
  for (std::size_t i = 0; i < re.size(); ++i) out.error.emplace_back(re[i], im[i]);
  out.variance = need(row, kVariance);
  out.bias = need(row, kBias);
  if (const auto* printed = row.array(kBiasPrinted)) out.bias_printed = *printed;
  return out;
}

// What a pass over the rows of a cell collects: one value a run for every figure of the table.
struct CellCoverage {
  std::uint64_t trials = 0, failed = 0;
  std::map<std::tuple<Region, std::size_t, int>, std::vector<double>>
      shares;  // region, level, element|joint|bonferroni
  std::map<std::pair<Region, std::size_t>, std::vector<double>> cdf;  // region, abscissa
  SnrSummary snr;
};

CellCoverage collect(std::uint32_t cell, const RowSource& rows) {
  CellCoverage out;
  // First pass: the sample mean of the errors, for the error against the mean.
  std::vector<std::complex<double>> mean;
  std::uint64_t n = 0;
  rows(cell, [&](const TrialRow& row) {
    ++out.trials;
    if (row.outcome != "ok") {
      ++out.failed;
      return;
    }
    const auto& re = need(row, kErrorReal);
    const auto& im = need(row, kErrorImag);
    mean.resize(re.size());
    for (std::size_t i = 0; i < re.size(); ++i) mean[i] += std::complex<double>(re[i], im[i]);
    ++n;
  });
  if (n == 0) return out;
  for (auto& value : mean) value /= static_cast<double>(n);
  const double inflate = n > 1 ? std::sqrt(static_cast<double>(n) / static_cast<double>(n - 1)) : 0.0;

  rows(cell, [&](const TrialRow& row) {
    if (row.outcome != "ok") return;
    TrialErrors errors = read_errors(row);
    for (std::size_t i = 0; i < mean.size(); ++i)
      errors.sample_error.push_back((errors.error[i] - mean[i]) * inflate);
    const auto elements = static_cast<std::size_t>(metric(row, kElements));
    const int q = static_cast<int>(metric(row, kDegreesOfFreedom));
    for (const Region region : kRegions) {
      if (region == Region::sample && n < 2) continue;
      if (needs_printed_constant(region) && errors.bias_printed.empty()) continue;
      for (std::size_t level = 0; level < kLevels.size(); ++level) {
        const TrialCoverage coverage = trial_coverage(errors, region, kLevels[level], elements, q);
        out.shares[{region, level, 0}].push_back(coverage.element);
        out.shares[{region, level, 1}].push_back(coverage.joint);
        out.shares[{region, level, 2}].push_back(coverage.bonferroni);
      }
      std::array<std::uint64_t, kCdfAbscissae.size()> below{};
      for (std::size_t i = 0; i < errors.error.size(); ++i) {
        const double square = normalised_square(errors, region, i);
        for (std::size_t x = 0; x < kCdfAbscissae.size(); ++x) below[x] += square <= kCdfAbscissae[x] ? 1 : 0;
      }
      for (std::size_t x = 0; x < kCdfAbscissae.size(); ++x) {
        out.cdf[{region, x}].push_back(static_cast<double>(below[x]) /
                                       static_cast<double>(errors.error.size()));
      }
    }
    out.snr.add(need(row, kInputSnr), static_cast<std::size_t>(metric(row, kInputs)));
  });
  // A trial without an estimate has no region that could hold the truth: it counts as outside.
  for (auto& [key, values] : out.shares) values.resize(out.trials, 0.0);
  for (auto& [key, values] : out.cdf) values.resize(out.trials, 0.0);
  return out;
}

TableRow percent_row(const std::string& table, const std::string& row, const std::string& quantity,
                     const std::vector<double>& shares, std::uint64_t n) {
  TableRow out = table_row(table, row, quantity, "%");
  fill_mean(out, shares, kPublishedRepetitions, 100.0);
  out.low = std::max(0.0, out.low);
  out.high = std::min(100.0, out.high);
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

void add_table_5_5(const CellCoverage& cell, const std::string& suffix,
                   const std::vector<PublishedFigure>& published, std::vector<TableRow>& out) {
  static constexpr std::array kScopes = {"", ", all elements of a line",
                                         ", all elements of a line, Bonferroni"};
  for (std::size_t level = 0; level < kLevels.size(); ++level) {
    for (const Region region : kRegions) {
      for (int scope = 0; scope < 3; ++scope) {
        const auto shares = cell.shares.find({region, level, scope});
        if (shares == cell.shares.end()) continue;
        // The joint rows of every variant would drown the table: those of the two regions in use suffice.
        if (scope > 0 && region != Region::plain && region != Region::extended) continue;
        TableRow row =
            percent_row("5-5", level_text(kLevels[level]) + suffix,
                        std::string(region_name(region)) + kScopes[static_cast<std::size_t>(scope)],
                        shares->second, cell.trials);
        const bool extended = region != Region::plain && region != Region::sample;
        if (scope == 0 && region != Region::plain) {
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

void add_figure_5_4(const CellCoverage& cell, const std::string& suffix, int q, std::vector<TableRow>& out) {
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
  std::vector<TableRow> table_5_5, figure_5_4, snr;
  for (std::uint32_t index = 0; index < spec.cells.size(); ++index) {
    const CellCoverage cell = collect(index, rows);
    if (cell.trials == cell.failed) continue;
    const std::string suffix = spec.cells.size() == 1 ? "" : ", " + spec.cells[index].name;
    int q = 0;
    rows(index, [&](const TrialRow& row) {
      if (row.outcome == "ok" && q == 0) q = static_cast<int>(metric(row, kDegreesOfFreedom));
    });
    const std::vector<PublishedFigure> figures =
        compared_with_print(spec, index) ? *published : std::vector<PublishedFigure>{};
    add_table_5_5(cell, suffix, figures, table_5_5);
    add_figure_5_4(cell, suffix, q, figure_5_4);
    cell.snr.add_rows(cell.trials - cell.failed, suffix, figures, snr);
  }
  std::vector<TableRow> out = std::move(table_5_5);
  out.insert(out.end(), figure_5_4.begin(), figure_5_4.end());
  out.insert(out.end(), snr.begin(), snr.end());
  return out;
}

const SummaryStudy kSummaryStudy{"coverage", &tables};

}  // namespace fatmc::coverage
