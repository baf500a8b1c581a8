// Alarms over histories whose answer is known.
#include "campaigns/dynamics_change/alarms.h"

#include <gtest/gtest.h>

#include <cmath>

namespace fatmc::dynamics_change {
namespace {

/// Window 400 s, epochs of 10 s, CSL 0.9 and noise level -10 throughout.
MonitoredRun quiet(double flown_s, double onset_s) {
  const auto epochs = static_cast<std::size_t>(flown_s / 10.0);
  MonitoredRun run;
  run.epoch_s = 10.0;
  run.window_s = 400.0;
  run.onset_s = onset_s;
  run.flown_s = flown_s;
  run.csl.assign(epochs, 0.9);
  run.robust.assign(epochs, 0.95);
  for (auto& noise : run.noise) noise.assign(epochs, -10.0);
  return run;
}

std::size_t epoch_at(double time_s) { return static_cast<std::size_t>(time_s / 10.0) - 1; }

constexpr double kNever = std::numeric_limits<double>::infinity();

TEST(AlarmStatistic, IsDefinedOnceTheWindowAndAQuarterAreFull) {
  const MonitoredRun run = quiet(1000.0, kNever);
  for (const Detector detector : kDetectors) {
    const std::vector<double> s = alarm_statistic(run, detector);
    EXPECT_TRUE(std::isnan(s[epoch_at(490.0)])) << name(detector);
    EXPECT_FALSE(std::isnan(s[epoch_at(500.0)])) << name(detector);
  }
  EXPECT_NEAR(alarm_statistic(run, Detector::csl).back(), 0.1, 1e-15);
  EXPECT_NEAR(alarm_statistic(run, Detector::robust).back(), 0.05, 1e-15);
  EXPECT_EQ(alarm_statistic(run, Detector::noise_rise).back(), 0.0);
}

TEST(AlarmStatistic, NoiseRiseIsThatOfTheLoudestOutputOverAQuarterWindow) {
  MonitoredRun run = quiet(1000.0, 600.0);
  for (std::size_t i = epoch_at(650.0); i < run.epochs(); ++i) {
    run.noise[1][i] = -8.5;
    run.noise[2][i] = -11.0;
  }
  const std::vector<double> s = alarm_statistic(run, Detector::noise_rise);
  EXPECT_EQ(s[epoch_at(640.0)], 0.0);
  EXPECT_EQ(s[epoch_at(650.0)], 1.5);
  EXPECT_EQ(s[epoch_at(740.0)], 1.5);
  EXPECT_EQ(s[epoch_at(750.0)], 0.0) << "a quarter window later the level is the new one";
  EXPECT_EQ(detection_delay(run, s, 1.0), 50.0);
  EXPECT_TRUE(std::isnan(detection_delay(run, s, 2.0)));
  EXPECT_EQ(quarter_window(run, s).before, 0.0);
  EXPECT_EQ(quarter_window(run, s).largest, 1.5);
}

TEST(Detection, AnAlarmThatWasOnBeforeSaysNothing) {
  MonitoredRun run = quiet(1000.0, 600.0);
  for (std::size_t i = epoch_at(590.0); i < run.epochs(); ++i) run.csl[i] = 0.0;
  EXPECT_TRUE(std::isnan(detection_delay(run, alarm_statistic(run, Detector::csl), 0.5)));
  run.csl[epoch_at(600.0)] = 0.9;  // off again in the last epoch before the change
  EXPECT_EQ(detection_delay(run, alarm_statistic(run, Detector::csl), 0.5), 10.0);
}

TEST(FalseAlarms, AreThoseOfTheFirstWholeHour) {
  MonitoredRun run = quiet(4200.0, kNever);
  EXPECT_NEAR(worst_of_hour(run, Detector::csl), 0.1, 1e-15);
  run.csl[epoch_at(490.0)] = 0.0;   // before
  run.csl[epoch_at(4100.0)] = 0.0;  // behind
  EXPECT_NEAR(worst_of_hour(run, Detector::csl), 0.1, 1e-15);
  run.csl[epoch_at(4090.0)] = 0.2;
  EXPECT_NEAR(worst_of_hour(run, Detector::csl), 0.8, 1e-15);
  EXPECT_TRUE(std::isnan(worst_of_hour(quiet(4200.0, 4000.0), Detector::csl))) << "something changes";
  EXPECT_TRUE(std::isnan(worst_of_hour(quiet(4000.0, kNever), Detector::csl))) << "too short";
}

TEST(CslFall, HasALevelBeforeATimeAndARecovery) {
  MonitoredRun run = quiet(1400.0, 450.0);
  for (std::size_t i = epoch_at(540.0); i <= epoch_at(880.0); ++i) run.csl[i] = 0.1;
  run.csl[epoch_at(600.0)] = 0.8;  // comes up for a moment
  const CslFall fall = csl_fall(run, run.csl);
  EXPECT_NEAR(fall.before, 0.9, 1e-12);
  EXPECT_EQ(fall.fall_s, 90.0);
  EXPECT_EQ(fall.recovery_s, 440.0);
  const CslFall none = csl_fall(run, run.robust);
  EXPECT_TRUE(std::isnan(none.fall_s) && std::isnan(none.recovery_s));
  const std::vector<double> nothing(run.epochs(), 0.01);
  EXPECT_TRUE(std::isnan(csl_fall(run, nothing).fall_s)) << "nothing to fall from";
}

}  // namespace
}  // namespace fatmc::dynamics_change
