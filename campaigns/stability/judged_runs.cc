#include "campaigns/stability/judged_runs.h"

#include <limits>

namespace fatmc::stability {
namespace {

std::vector<double> product_over_lines(const LineRuns& p) {
  std::vector<double> out(p.runs(), 1.0);
  for (std::size_t k = 0; k < p.lines(); ++k) {
    for (std::size_t run = 0; run < out.size(); ++run) out[run] *= p.line(k)[run];
  }
  return out;
}

void add_failed_run(JudgedRuns& out) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const auto add = [&out](const std::string& name, double value) {
    out.arrays[name].add(std::vector<double>(out.frequency_hz.size(), value));
  };
  for (const auto name : {kNominalHInfinity, kNominalSsv}) add(std::string(name), kInfinity);
  add(std::string(kSmallestSnr), -kInfinity);
  for (const Reading& reading : kReadings) {
    for (const Criterion criterion : {Criterion::h_infinity, Criterion::ssv}) {
      add(value_array(reading, criterion), kInfinity);
      for (const Rule rule : kRules) add(confidence_array(reading, criterion, rule), 0.0);
    }
  }
}

}  // namespace

std::vector<std::size_t> JudgedRuns::lines_between(double low_hz, double high_hz) const {
  constexpr double kSlack = 1e-4;  // frequencies are whole multiples of 5 mHz
  std::vector<std::size_t> out;
  for (std::size_t k = 0; k < frequency_hz.size(); ++k) {
    if (frequency_hz[k] >= low_hz - kSlack && frequency_hz[k] <= high_hz + kSlack) out.push_back(k);
  }
  return out;
}

std::vector<double> JudgedRuns::band(const Reading& reading, Criterion criterion, Rule rule) const {
  return product_over_lines(confidence(reading, criterion, rule));
}

LineRuns JudgedRuns::total(const Reading& reading, Criterion criterion, Rule rule) const {
  const LineRuns& p = confidence(reading, criterion, rule);
  const LineRuns& nominal =
      array(std::string(criterion == Criterion::h_infinity ? kNominalHInfinity : kNominalSsv));
  const LineRuns& snr = array(std::string(kSmallestSnr));
  LineRuns out;
  std::vector<double> run_values(p.lines());
  for (std::size_t run = 0; run < p.runs(); ++run) {
    for (std::size_t k = 0; k < p.lines(); ++k) {
      const bool counts = nominal.line(k)[run] < 1.0 && snr.line(k)[run] >= minimum_snr_db;
      run_values[k] = counts ? p.line(k)[run] : 0.0;
    }
    out.add(run_values);
  }
  return out;
}

std::vector<double> JudgedRuns::total_band(const Reading& reading, Criterion criterion, Rule rule) const {
  return product_over_lines(total(reading, criterion, rule));
}

JudgedRuns judged_runs(std::uint32_t cell, const RowSource& rows) {
  JudgedRuns out;
  rows(cell, [&](const TrialRow& row) {
    ++out.trials;
    if (row.outcome != "ok") {
      ++out.failed;
      return;
    }
    if (out.frequency_hz.empty()) {
      out.frequency_hz = array_of(row, kFrequency);
      out.minimum_snr_db = metric_of(row, kMinimumSnr);
    }
    const auto add = [&](const std::string& name) { out.arrays[name].add(array_of(row, name)); };
    for (const auto name : {kNominalHInfinity, kNominalSsv, kSmallestSnr}) add(std::string(name));
    for (const Reading& reading : kReadings) {
      for (const Criterion criterion : {Criterion::h_infinity, Criterion::ssv}) {
        add(value_array(reading, criterion));
        for (const Rule rule : kRules) add(confidence_array(reading, criterion, rule));
      }
    }
  });
  if (out.frequency_hz.empty()) return out;
  for (std::uint64_t run = 0; run < out.failed; ++run) add_failed_run(out);
  return out;
}

}  // namespace fatmc::stability
