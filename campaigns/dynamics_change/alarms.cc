#include "campaigns/dynamics_change/alarms.h"

#include <algorithm>
#include <cmath>

namespace fatmc::dynamics_change {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kRounding = 1e-9;  // s, of times that are multiples of an epoch

double quarter(const MonitoredRun& run) { return run.window_s / 4.0; }

/// When a detector's statistic is first defined.
double defined_from(const MonitoredRun& run) { return run.window_s + quarter(run); }

}  // namespace

std::string_view name(Detector detector) {
  switch (detector) {
    case Detector::csl:
      return "CSL";
    case Detector::robust:
      return "CSL without gates";
    case Detector::noise_rise:
      return "noise rise";
  }
  return "?";
}

std::vector<double> alarm_statistic(const MonitoredRun& run, Detector detector) {
  std::vector<double> out(run.epochs(), kNan);
  const auto lag = static_cast<std::size_t>(std::llround(quarter(run) / run.epoch_s));
  for (std::size_t i = lag; i < out.size(); ++i) {
    if (run.time(i) < defined_from(run) - kRounding) continue;  // both for the same epochs
    if (detector != Detector::noise_rise) {
      out[i] = 1.0 - (detector == Detector::csl ? run.csl : run.robust)[i];
      continue;
    }
    double rise = -std::numeric_limits<double>::infinity();
    for (const std::vector<double>& noise : run.noise) rise = std::max(rise, noise[i] - noise[i - lag]);
    out[i] = rise;
  }
  return out;
}

double worst_of_hour(const MonitoredRun& run, Detector detector) {
  const double from = defined_from(run);
  const double to = from + kHour;
  if (run.onset_s < to || run.flown_s < to - kRounding) return kNan;
  const std::vector<double> statistic = alarm_statistic(run, detector);
  double worst = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < statistic.size(); ++i) {
    if (run.time(i) >= from - kRounding && run.time(i) < to - kRounding)
      worst = std::max(worst, statistic[i]);
  }
  return worst;
}

double detection_delay(const MonitoredRun& run, const std::vector<double>& statistic, double threshold) {
  bool on_before = false;
  for (std::size_t i = 0; i < statistic.size(); ++i) {
    const bool on = statistic[i] > threshold;
    if (run.time(i) <= run.onset_s) {
      on_before = on;
    } else if (on) {
      return on_before ? kNan : run.time(i) - run.onset_s;
    }
  }
  return kNan;
}

QuarterWindow quarter_window(const MonitoredRun& run, const std::vector<double>& statistic) {
  QuarterWindow out;
  for (std::size_t i = 0; i < statistic.size(); ++i) {
    const double since = run.time(i) - run.onset_s;
    if (since <= 0.0) out.before = statistic[i];
    if (since > 0.0 && since <= quarter(run) + kRounding && !(statistic[i] <= out.largest))
      out.largest = statistic[i];
  }
  return out;
}

CslFall csl_fall(const MonitoredRun& run, const std::vector<double>& csl) {
  CslFall out;
  double sum = 0.0, at_onset = 0.0;
  int n = 0;
  for (std::size_t i = 0; i < run.epochs(); ++i) {
    const double since = run.time(i) - run.onset_s;
    if (since <= 0.0 && since > -quarter(run) && run.time(i) >= run.window_s - kRounding) {
      sum += csl[i];
      at_onset = csl[i];
      ++n;
    }
  }
  if (n == 0) return out;
  out.before = sum / n;
  if (out.before < 0.1 || at_onset < 0.5 * out.before) return out;  // nothing to fall from, or down already
  std::size_t last_low = run.epochs();
  for (std::size_t i = 0; i < run.epochs(); ++i) {
    if (run.time(i) <= run.onset_s || csl[i] >= 0.5 * out.before) continue;
    if (std::isnan(out.fall_s)) out.fall_s = run.time(i) - run.onset_s;
    last_low = i;
  }
  if (last_low + 1 < run.epochs()) out.recovery_s = run.time(last_low + 1) - run.onset_s;
  return out;
}

}  // namespace fatmc::dynamics_change
