#include "campaigns/variance/summary.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "campaigns/base/prepared_trials.h"
#include "campaigns/base/table_order.h"
#include "campaigns/base/verdict.h"
#include "campaigns/flown/flown_cell.h"
#include "campaigns/variance/element_runs.h"
#include "core/ident/window_polynomial.h"

namespace fatmc::variance {
namespace {

using Picks = std::span<const std::size_t>;

// The border reaches n_E = 10 lines: T compares the first line with the 11th, 0.05 with 0.15 Hz, and 5.0 with 4.9 Hz.
struct Border {
  const char* name;
  double edge_hz, inner_hz;
};
constexpr std::array kBorders = {Border{"low border", 0.05, 0.15}, Border{"high border", 5.0, 4.9}};

double mean_over_elements(const auto& of_element) {
  double sum = 0.0;
  for (std::size_t e = 0; e < kElements; ++e) sum += of_element(e);
  return sum / kElements;
}

class CellTables {
 public:
  CellTables(const ElementRuns& runs, LpmOptions fit, std::string suffix,
             const std::vector<PublishedFigure>& published, std::vector<TableRow>& out)
      : runs_(runs), fit_(fit), suffix_(std::move(suffix)), published_(published), out_(out) {}

  // "The median of sigma^2_LPM coincides well with sigma^2_MC for all responses" (4.3.2), as a ratio in dB: over all lines
  // shown, those whose window is not shifted, and each border.
  void add_agreement() {
    const std::size_t lines = runs_.frequency_hz.size();
    const auto ratio = [&](std::size_t first, std::size_t last) {
      return [&, first, last](Picks picks) {
        const RunCounts counts(runs_.runs(), picks);
        double sum = 0.0;
        for (std::size_t k = first; k < last; ++k) sum += ratio_db(k, counts, picks);
        return sum / static_cast<double>(last - first);
      };
    };
    const std::size_t low = runs_.nearest_line(kBorders[0].inner_hz),
                      high = runs_.nearest_line(kBorders[1].inner_hz);
    const char* quantity = "median estimated over between runs, mean of dB";
    // Of the lines kept 32 of 78 lie at the borders, of the lines flown 32 of 496.
    statistic("Section 4.3.2", "lines of Fig. 4-3, all alike", quantity, "dB", "", ratio(0, lines));
    statistic("Section 4.3.2", "lines of Fig. 4-3, by the band they stand for", quantity, "dB", "",
              over_band());
    if (low < high) statistic("Section 4.3.2", "0.15-4.9 Hz", quantity, "dB", "", ratio(low, high + 1));
    if (low > 0) statistic("Section 4.3.2", "below 0.15 Hz", quantity, "dB", "", ratio(0, low));
    if (high + 1 < lines)
      statistic("Section 4.3.2", "above 4.9 Hz", quantity, "dB", "", ratio(high + 1, lines));
  }

  void add_border_factors() {
    for (const Border& border : kBorders) {
      const std::size_t edge = runs_.nearest_line(border.edge_hz),
                        inner = runs_.nearest_line(border.inner_hz);
      const char* why =
          "print is the factor of one input; three inputs of random phases have 5.1 in white noise";
      add_white_noise_factor(border.name);
      statistic("Section 4.3.3", border.name, "border factor, between runs", "", why,
                [&, edge, inner](Picks picks) {
                  return mean_over_elements([&](std::size_t e) {
                    return runs_.between_runs(edge, e, picks) / runs_.between_runs(inner, e, picks);
                  });
                });
      statistic("Section 4.3.3", border.name, "border factor, medians of the estimates", "", "",
                [&, edge, inner](Picks picks) {
                  const RunCounts counts(runs_.runs(), picks);
                  return mean_over_elements([&](std::size_t e) {
                    return estimated_.quantile(ElementRuns::at(edge, e), 0.5, counts) /
                           estimated_.quantile(ElementRuns::at(inner, e), 0.5, counts);
                  });
                });
    }
  }

 private:
  /// Estimated over observed variance at a line, mean of dB over the elements.
  [[nodiscard]] double ratio_db(std::size_t k, const RunCounts& counts, Picks picks) const {
    return mean_over_elements([&](std::size_t e) {
      return 10.0 * std::log10(estimated_.quantile(ElementRuns::at(k, e), 0.5, counts) /
                               runs_.between_runs(k, e, picks));
    });
  }

  /// Mean over frequency by the trapezoidal rule.
  [[nodiscard]] RunStatistic over_band() const {
    return [this](Picks picks) {
      const RunCounts counts(runs_.runs(), picks);
      const std::vector<double>& f = runs_.frequency_hz;
      double sum = 0.0, before = ratio_db(0, counts, picks);
      for (std::size_t k = 1; k < f.size(); ++k) {
        const double here = ratio_db(k, counts, picks);
        sum += 0.5 * (here + before) * (f[k] - f[k - 1]);
        before = here;
      }
      return sum / (f.back() - f.front());
    };
  }

  // What the cell's fit through 2 n_E + 1 even lines makes of white noise: |s|^2 of the constant row at the edge over that in the
  // middle. With one input the covariance factor A is this; with several it hangs on their phases.
  void add_white_noise_factor(const char* border) {
    const int lines = 2 * fit_.n_e + 1;
    const auto gain = [&](int place) {
      const double scale = std::max(place, lines - 1 - place);
      std::vector<double> scaled;
      for (int i = 0; i < lines; ++i) scaled.push_back((i - place) / scale);
      double sum = 0.0;
      for (const double s : window_polynomial(scaled, scale, fit_.order).own_constant) sum += s * s;
      return sum;
    };
    TableRow out = table_row("Section 4.3.3", border, "border factor, white noise, one input", "");
    TableRow printed = out;
    printed.quantity = "border factor, between runs";
    out.published = published_value(published_, printed);
    out.row += suffix_;
    out.value = gain(0) / gain(fit_.n_e);
    judge_exact(out, 0.1, "noise rises towards low frequencies, and there are three inputs");
    out_.push_back(std::move(out));
  }

  void statistic(const std::string& table, const std::string& row, const std::string& quantity,
                 const std::string& unit, std::string_view why, const RunStatistic& of) {
    TableRow out = table_row(table, row, quantity, unit);
    out.published = published_value(published_, out);
    out.row += suffix_;
    if (runs_.failed > 0) out.why = std::to_string(runs_.failed) + " trials without an estimate";
    fill_statistic(out, runs_.runs(), kPublishedRepetitions, of,
                   unit == "dB" ? StatisticScale::additive : StatisticScale::ratio);
    judge_by_order(out, why);
    out_.push_back(std::move(out));
  }

  const ElementRuns& runs_;
  LpmOptions fit_;
  SortedRuns estimated_{runs_.variance};
  std::string suffix_;
  const std::vector<PublishedFigure>& published_;
  std::vector<TableRow>& out_;
};

}  // namespace

Result<std::vector<TableRow>> tables(const CampaignSpec& spec, const RowSource& rows) {
  auto published = decode_published(spec);
  if (!published) return fail(published.error());
  std::vector<TableRow> out;
  for (std::uint32_t index = 0; index < spec.cells.size(); ++index) {
    const ElementRuns runs = element_runs(index, rows);
    if (runs.runs() < 2) continue;  // one run has no scatter
    const std::vector<PublishedFigure> figures =
        compared_with_print(spec, index) ? *published : std::vector<PublishedFigure>{};
    const auto own = spec_of_cell(spec, index);
    if (!own) return fail(own.error());
    const auto flown = decode_flown_cell(*own, 0);
    if (!flown) return fail(flown.error());
    CellTables cell(runs, flown->estimator, spec.cells.size() == 1 ? "" : ", " + spec.cells[index].name,
                    figures, out);
    cell.add_agreement();
    cell.add_border_factors();
  }
  group_by_table(out);
  return out;
}

const SummaryStudy kSummaryStudy{"variance", &tables, &figures};

}  // namespace fatmc::variance
