#include "core/flight/step_parts.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/flight/flight.h"
#include "tests/unit/flight/fat.h"

namespace fatmc {
namespace {

int parts(const Aircraft& aircraft, double step_s = 0.02) {
  return parts_of_step(aircraft, linearize(aircraft, trim_level(aircraft)), step_s);
}

TEST(StepParts, ThePublishedAircraftIsFlownInWholeSteps) {
  EXPECT_EQ(parts(fat()), 1);
  // Its fastest pole is -56.37 1/s: 1.5/56.37 s = 26.6 ms.
  EXPECT_EQ(parts(fat(), 0.0260), 1);
  EXPECT_EQ(parts(fat(), 0.0272), 2);
}

TEST(StepParts, FollowTheFasterPoleOfADampedServo) {
  Aircraft aircraft = fat();
  aircraft.aileron.damping = 0.9 * 2.1;
  const double d = aircraft.aileron.damping, fastest = 40.0 * (d + std::sqrt(d * d - 1.0));
  EXPECT_NEAR(fastest, 139.8, 0.1);
  EXPECT_EQ(parts(aircraft), static_cast<int>(std::ceil(fastest * 0.02 / kLargestModeStep)));
  aircraft.aileron.damping = 0.9 * 20.0;
  EXPECT_EQ(parts(aircraft), 20);
}

TEST(StepParts, KnowModesThatTheLinearModelDoesNot) {
  Aircraft aircraft = fat();
  aircraft.additional.flexible[1] = {24.0, 0.03, 0.01};
  EXPECT_EQ(parts(aircraft), 3);  // 2 pi 24 * 0.02 = 3.02
  aircraft.additional.flexible[1].slope = 0.0;
  EXPECT_EQ(parts(aircraft), 1);
}

/// Largest step by which a servo's deflection still changes a second after a step of the command.
double restlessness(double damping) {
  Aircraft aircraft = fat();
  aircraft.aileron.damping = damping;
  FlightSetup setup;
  setup.closed_loop = false;
  const auto flight = Flight::prepare(aircraft, setup);
  EXPECT_TRUE(flight) << flight.error().text();
  Eigen::MatrixX3d command = Eigen::MatrixX3d::Zero(100, 3);
  command.col(0).setConstant(0.02);
  FlightRecord record;
  flight->fly(command, {}, record);
  EXPECT_EQ(record.ending, Ending::completed);
  double most = 0.0;
  for (Eigen::Index t = 52; t < 100; ++t) {
    const double bend = record.output(t, 0) - 2.0 * record.output(t - 1, 0) + record.output(t - 2, 0);
    most = std::max(most, std::abs(bend));
  }
  return most;
}

TEST(StepParts, KeepAStiffServoStable) {
  // Beyond -2.785/0.02 s = -139.3 1/s whole steps would grow without end. The rate is smooth with either servo.
  EXPECT_LT(restlessness(0.9 * 2.1), 2.0 * restlessness(0.9) + 1e-4);
  EXPECT_LT(restlessness(0.9 * 20.0), 1e-3);
}

TEST(StepParts, ThatWouldBeTooManyAreRefused) {
  Aircraft aircraft = fat();
  aircraft.aileron.frequency_rad_s = 1e5;
  const auto flight = Flight::prepare(aircraft, {});
  ASSERT_FALSE(flight);
  EXPECT_EQ(flight.error().key, "step_s");
}

}  // namespace
}  // namespace fatmc
