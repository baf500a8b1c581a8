#include "campaigns/dynamics_change/summary.h"

#include <algorithm>
#include <cmath>

#include "campaigns/base/decoder.h"
#include "campaigns/base/table_order.h"
#include "campaigns/base/verdict.h"
#include "campaigns/dynamics_change/alarms.h"
#include "core/base/text.h"
#include "core/stats/empirical.h"
#include "core/stats/intervals.h"

namespace fatmc::dynamics_change {
namespace {

constexpr std::size_t kPublishedRuns = 1;  // Fig. 5-16 shows one flight

// By `--scale 20`: README.md.
constexpr const char* kZeros =
    "with the gates zero until 380 s (median 390), since the input SNR of some line is below 20 dB while the "
    "window fills; "
    "without them above one half from 20 to 210 s on (median 110), since few samples look like a transient";
constexpr const char* kGate =
    "the SNR gate alone makes the CSL zero in 53 % of the epochs before a change, and what it does next is "
    "as likely a fall";
constexpr const char* kScatter = "single flights scatter from 49 to 272 s";

RunStatistic median_of(const std::vector<double>& values) {
  return [&values](std::span<const std::size_t> picks) {
    std::vector<double> picked;
    for (const std::size_t i : picks) picked.push_back(values[i]);
    return EmpiricalCdf(std::move(picked)).quantile(0.5);
  };
}

/// Median over the runs that have a value, n of them; beside print the interval of a single flight, else that of our median. Times
/// since the change are positive: intervals by their logarithms.
TableRow median_row(std::string table, const std::string& row, std::string quantity,
                    std::vector<double> values, bool beside_print) {
  TableRow out = table_row(std::move(table), row, std::move(quantity), "s");
  std::erase_if(values, [](double value) { return std::isnan(value); });
  out.n = values.size();
  if (values.empty()) return out;
  if (beside_print) {
    fill_statistic(out, values.size(), kPublishedRuns, median_of(values), StatisticScale::ratio);
    return out;
  }
  std::vector<std::size_t> all(values.size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
  out.value = median_of(values)(all);
  if (values.size() < kFewestRuns) return out;
  std::vector<double> logarithms;
  for (const double value : values) logarithms.push_back(std::log(value));
  const Interval interval = bootstrap_interval(values.size(), median_of(logarithms));
  out.low = std::exp(interval.low);
  out.high = std::exp(interval.high);
  return out;
}

TableRow share_row(std::string table, const std::string& row, std::string quantity, std::uint64_t hits,
                   std::uint64_t runs) {
  TableRow out = table_row(std::move(table), row, std::move(quantity), "%");
  out.n = runs;
  if (runs == 0) return out;
  const Interval interval = proportion_interval(hits, runs);
  out.value = 100.0 * static_cast<double>(hits) / static_cast<double>(runs);
  out.low = 100.0 * interval.low;
  out.high = 100.0 * interval.high;
  return out;
}

std::string missing_note(const std::vector<double>& values, const char* what) {
  const auto missing = std::count_if(values.begin(), values.end(), [](double v) { return std::isnan(v); });
  return missing == 0 ? ""
                      : std::to_string(missing) + " of " + std::to_string(values.size()) + " runs " + what;
}

class CellTable {
 public:
  CellTable(std::string name, const MonitoredCell& cell, const AlarmThresholds& thresholds,
            const std::vector<PublishedFigure>& published, std::vector<TableRow>& out)
      : name_(std::move(name)), cell_(cell), thresholds_(thresholds), published_(published), out_(out) {}

  void add() {
    const bool changes = std::any_of(cell_.runs.begin(), cell_.runs.end(),
                                     [](const MonitoredRun& run) { return std::isfinite(run.onset_s); });
    if (changes) {
      for (const Detector rule : {Detector::csl, Detector::robust}) add_fall(rule);
      for (const Detector detector : kDetectors) add_detection(detector);
    } else {
      for (const Detector detector : kDetectors) add_false_alarms(detector);
    }
  }

 private:
  [[nodiscard]] double threshold(Detector detector) const {
    return detector == Detector::noise_rise ? thresholds_.noise_rise : 1.0 - thresholds_.csl;
  }
  [[nodiscard]] std::string alarm(Detector detector) const {
    const bool rise = detector == Detector::noise_rise;
    return std::string(name(detector)) +
           (rise ? " above " + shortest(thresholds_.noise_rise) : " below " + shortest(thresholds_.csl));
  }

  [[nodiscard]] std::string not_flown() const {
    return cell_.without_flight == 0 ? "" : std::to_string(cell_.without_flight) + " trials without a flight";
  }
  static std::string joined(const std::string& one, const std::string& other) {
    return one + (one.empty() || other.empty() ? "" : "; ") + other;
  }

  void add_fall(Detector rule) {
    const std::string csl_name(name(rule));
    std::vector<double> fall, recovery, empty_window;
    for (const MonitoredRun& run : cell_.runs) {
      const std::vector<double>& csl = rule == Detector::csl ? run.csl : run.robust;
      const CslFall at = csl_fall(run, csl);
      fall.push_back(at.fall_s);
      recovery.push_back(at.recovery_s);
      if (!csl.empty()) empty_window.push_back(csl.front());
    }
    TableRow row = median_row("Fig. 5-16", name_, csl_name + " falls below half, after", fall, true);
    row.published = published_value(published_, row);
    const std::string without = missing_note(fall, "without a fall, or with nothing to fall from");
    if (!without.empty()) row.why += (row.why.empty() ? "" : "; ") + without;
    judge_by_order(row, rule == Detector::csl ? kGate : kScatter);
    out_.push_back(std::move(row));
    TableRow back =
        median_row("Fig. 5-16", name_, csl_name + " back above half for good, after", recovery, false);
    back.why = missing_note(recovery, "have not come back, or have not fallen");
    out_.push_back(std::move(back));
    if (published_.empty()) return;
    TableRow zeros = table_row("Fig. 5-16", name_, csl_name + " of the first epoch, mostly zeros", "1");
    fill_mean(zeros, empty_window, kPublishedRuns);
    zeros.published = published_value(published_, zeros);
    judge_by_order(zeros, kZeros);
    out_.push_back(std::move(zeros));
  }

  void add_detection(Detector detector) {
    std::vector<double> delays;
    std::uint64_t in_time = 0;
    for (const MonitoredRun& run : cell_.runs) {
      delays.push_back(detection_delay(run, alarm_statistic(run, detector), threshold(detector)));
      in_time += delays.back() <= run.window_s / 4.0 ? 1 : 0;
    }
    // What could not be flown was not detected.
    TableRow share = share_row("Section 5.7", name_, alarm(detector) + ": within a quarter window", in_time,
                               delays.size() + cell_.without_flight);
    share.why = joined(missing_note(delays, "never, or with an alarm that was on before"), not_flown());
    out_.push_back(std::move(share));
    out_.push_back(median_row("Section 5.7", name_, alarm(detector) + ": delay", delays, false));
  }

  void add_false_alarms(Detector detector) {
    std::uint64_t hours = 0, alarmed = 0;
    for (const MonitoredRun& run : cell_.runs) {
      const double worst = worst_of_hour(run, detector);
      if (std::isnan(worst)) continue;
      ++hours;
      alarmed += worst > threshold(detector) ? 1 : 0;
    }
    TableRow share =
        share_row("Section 5.7", name_, alarm(detector) + ": hours with a false alarm", alarmed, hours);
    share.why = joined(hours < cell_.runs.size()
                           ? std::to_string(cell_.runs.size() - hours) + " flights without a whole hour"
                           : "",
                       not_flown());
    out_.push_back(std::move(share));
  }

  std::string name_;
  const MonitoredCell& cell_;
  const AlarmThresholds& thresholds_;
  const std::vector<PublishedFigure>& published_;
  std::vector<TableRow>& out_;
};

}  // namespace

Result<AlarmThresholds> decode_thresholds(const CampaignSpec& spec) {
  AlarmThresholds out;
  const Tree* tree = spec.tree.find("alarm");
  if (tree == nullptr)
    return fail(Error{spec.tree.file, 0, "alarm", "is missing: csl = 0.5, noise_rise = ..."});
  Decoder table(*tree, "alarm");
  out.csl = table.real("csl", {.low = 0.0, .high = 1.0});
  out.noise_rise = table.real("noise_rise", {.low = 0.0, .high = 100.0});
  if (Status status = table.finish(); !status) return fail(status.error());
  return out;
}

Result<std::vector<TableRow>> tables(const CampaignSpec& spec, const RowSource& rows) {
  auto published = decode_published(spec);
  if (!published) return fail(published.error());
  const auto thresholds = decode_thresholds(spec);
  if (!thresholds) return fail(thresholds.error());
  std::vector<TableRow> out;
  for (std::uint32_t index = 0; index < spec.cells.size(); ++index) {
    const MonitoredCell cell = read_cell(index, rows);
    if (cell.runs.empty()) continue;
    const std::vector<PublishedFigure> figures =
        compared_with_print(spec, index) ? *published : std::vector<PublishedFigure>{};
    CellTable(spec.cells[index].name, cell, *thresholds, figures, out).add();
  }
  group_by_table(out);
  return out;
}

const SummaryStudy kSummaryStudy{"dynamics_change", &tables, &figures};

}  // namespace fatmc::dynamics_change
