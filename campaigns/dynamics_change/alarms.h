// Alarms over a monitored flight, and what they cost.
//
//   confident stability level   alarm where CSL < threshold: T's (section 5.7, Fig. 5-16)
//   CSL without gates           the same without the gates of nominal stability and SNR (2.272): robust stability alone
//   noise rise                  alarm where D(t) = max over p, q, r of L_i(t) - L_i(t - W/4) > threshold, L_i the mean over the
//                               lines of ln C_V_noise,ii. A change within the window makes the record aperiodic: the response
//                               to the references no longer repeats, and leaks into the lines between, from which the noise
//                               is estimated. W/4 is the delay within which T promises detection.
//
// An alarm sounds at an epoch and can be false only where the window is full and nothing has changed yet.
#pragma once

#include <limits>
#include <vector>

#include "campaigns/dynamics_change/monitored_runs.h"

namespace fatmc::dynamics_change {

enum class Detector { csl, robust, noise_rise };
inline constexpr Detector kDetectors[] = {Detector::csl, Detector::robust, Detector::noise_rise};
std::string_view name(Detector detector);

/// What is compared with a threshold, larger is worse, one value an epoch: 1 - CSL, or D. NaN while it is not defined.
std::vector<double> alarm_statistic(const MonitoredRun& run, Detector detector);

inline constexpr double kHour = 3600.0;

/// Largest statistic over the first hour in which all of it is defined; NaN where the flight holds no such hour, or
/// something changes within it.
double worst_of_hour(const MonitoredRun& run, Detector detector);

/// From the onset to the first epoch above the threshold, in s. NaN: never; or the alarm was on when the change began,
/// so that it says nothing.
double detection_delay(const MonitoredRun& run, const std::vector<double>& statistic, double threshold);

/// Largest statistic between the onset and a quarter window later, and the last one before the onset.
struct QuarterWindow {
  double before = std::numeric_limits<double>::quiet_NaN();
  double largest = std::numeric_limits<double>::quiet_NaN();
};
QuarterWindow quarter_window(const MonitoredRun& run, const std::vector<double>& statistic);

/// The CSL's fall after a change: level before (mean over a quarter window), time until it is below half of that, time until
/// it is back above half of it for good. NaN where there is none, or nothing to fall from (below 0.1).
struct CslFall {
  double before = std::numeric_limits<double>::quiet_NaN();
  double fall_s = std::numeric_limits<double>::quiet_NaN();
  double recovery_s = std::numeric_limits<double>::quiet_NaN();
};
CslFall csl_fall(const MonitoredRun& run, const std::vector<double>& csl);

}  // namespace fatmc::dynamics_change
