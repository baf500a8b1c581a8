// Effects that begin in flight.
#include <gtest/gtest.h>

#include <cmath>

#include "core/flight/effects/effect.h"
#include "tests/unit/flight/fat.h"

namespace fatmc {
namespace {

FlightRecord fly(std::string_view text, const Eigen::MatrixX3d& r, FlightSetup setup = {}) {
  std::vector<Effect> effects;
  if (!text.empty()) effects.push_back(*parse_effect(text));
  const Result<ModifiedFlight> modified = apply(fat(), setup, effects);
  const Result<Flight> flight = Flight::prepare(modified->aircraft, modified->setup);
  EXPECT_TRUE(flight.has_value()) << flight.error().text();
  FlightRecord record;
  flight->fly(r, TrialSeed{1, 2, 3, 4}, record);
  return record;
}

Eigen::MatrixX3d waves(Eigen::Index ticks, double amplitude) {
  Eigen::MatrixX3d r(ticks, 3);
  for (Eigen::Index t = 0; t < ticks; ++t) {
    const double s = 0.02 * static_cast<double>(t);
    r.row(t) << amplitude * std::sin(3.0 * s), amplitude * std::sin(4.0 * s), amplitude * std::sin(5.0 * s);
  }
  return r;
}

FlightSetup windy() {
  FlightSetup setup;
  setup.turbulence_m_s = 0.5;
  return setup;
}

TEST(Onset, TheFlightBeforeIsTheUnmodifiedOneToRounding) {
  const Eigen::MatrixX3d r = waves(500, 0.2);
  const FlightRecord plain = fly("", r, windy());
  for (const char* text :
       {"control_effectiveness:axis=roll,factor=3,onset_s=6", "transport_delay:delay_s=0.05,onset_s=6",
        "gyro_scale:axis=roll,error=0.3,onset_s=6", "mass:factor=0.8,onset_s=6"}) {
    const FlightRecord record = fly(text, r, windy());
    // Another instance of the loop: the compiler may round otherwise.
    EXPECT_LT((record.output - plain.output).topRows(300).cwiseAbs().maxCoeff(), 1e-13) << text;
    EXPECT_GT((record.output - plain.output).bottomRows(150).cwiseAbs().maxCoeff(), 1e-4) << text;
  }
}

TEST(Onset, ASuddenChangeFliesOnAsTheChangedAircraft) {
  // From the first tick on: the stages of a change at the first tick are those of an aircraft that was so at once, but
  // for the trim, which the aileron has no part in.
  const Eigen::MatrixX3d r = waves(500, 0.2);
  const FlightRecord early = fly("control_effectiveness:axis=roll,factor=2,onset_s=0", r);
  const FlightRecord always = fly("control_effectiveness:axis=roll,factor=2", r);
  EXPECT_EQ(early.output, always.output);
}

TEST(Onset, ADriftPassesThroughTheValuesBetween) {
  const Result<ModifiedFlight> modified =
      apply(fat(), FlightSetup{}, {{*parse_effect("cm_q:factor=4,onset_s=10,duration_s=50")}});
  ASSERT_TRUE(modified.has_value());
  const std::vector<FlightStage>& stages = modified->setup.stages;
  ASSERT_EQ(stages.size(), 101u);
  EXPECT_EQ(stages.front().from_s, 10.0);
  EXPECT_EQ(stages.back().from_s, 60.0);
  EXPECT_EQ(stages.back().aircraft.pitch.q, 4.0 * fat().pitch.q);
  // A factor drifts geometrically: half the way is its square root, here between the steps 49 and 50.
  const double half = std::sqrt(stages[49].aircraft.pitch.q * stages[50].aircraft.pitch.q);
  EXPECT_NEAR(half / std::abs(fat().pitch.q), 2.0, 1e-9);
  for (std::size_t i = 1; i < stages.size(); ++i) {
    EXPECT_LT(stages[i].aircraft.pitch.q, stages[i - 1].aircraft.pitch.q);
  }
}

TEST(Onset, NobodyTrimsAChangeAway) {
  // A heavier aircraft from 2 s on sinks: the command of the elevator is feedback alone.
  const FlightRecord record = fly("mass:factor=1.2,onset_s=2", Eigen::MatrixX3d::Zero(500, 3));
  EXPECT_LT(record.auxiliary.col(2).head(100).array().abs().maxCoeff() - 24.0, 1e-9);
  EXPECT_GT((record.auxiliary.col(2).tail(100).array() - 24.0).abs().maxCoeff(), 0.1);
  EXPECT_LT((record.input.col(1) + 0.1 * record.output.col(1)).cwiseAbs().maxCoeff(), 1e-15);
}

TEST(Onset, AStuckSurfaceStaysAndAFloatingOneIsNotFelt) {
  FlightSetup open;
  open.closed_loop = false;
  Eigen::MatrixX3d u = Eigen::MatrixX3d::Zero(200, 3);
  u.col(0).setConstant(0.02);
  u.block(100, 0, 100, 1).setConstant(-0.05);  // what the stuck aileron no longer follows
  Eigen::MatrixX3d kept = u;
  kept.block(100, 0, 100, 1).setConstant(0.02);
  const FlightRecord stuck = fly("surface_loss:surface=aileron,failure=stuck,share=1,onset_s=2", u, open);
  const FlightRecord wanted = fly("", kept, open);
  EXPECT_LT((stuck.output - wanted.output).cwiseAbs().maxCoeff(), 1e-5);

  // Without the left ruddervator, yaw demands half a rudder and half an elevator.
  Eigen::MatrixX3d yaw = Eigen::MatrixX3d::Zero(100, 3);
  yaw.col(2).setConstant(0.02);
  Eigen::MatrixX3d half = Eigen::MatrixX3d::Zero(100, 3);
  half.col(2).setConstant(0.01);
  half.col(1).setConstant(0.01);
  const FlightRecord lost = fly("surface_loss:surface=left_ruddervator,failure=floating,share=1", yaw, open);
  // The lost surface takes its trim deflection along, 2e-8 rad here.
  EXPECT_LT((lost.output - fly("", half, open).output).cwiseAbs().maxCoeff(), 1e-7);
}

TEST(Onset, AModeThatBecomesUnstableGrowsUntilTheGyrosAreFull) {
  FlightSetup setup;
  setup.imu.range_rad_s = 5.0;
  setup.imu.bits = 32;
  const FlightRecord record =
      fly("flexible_mode:axis=roll,slope=0.01,frequency_hz=1.5,damping=-0.02,onset_s=20", waves(4000, 0.1),
          setup);
  const double before = record.output.col(0).segment(500, 500).cwiseAbs().maxCoeff();
  ASSERT_GT(record.samples, 1500);
  const double after = record.output.col(0).segment(record.samples - 200, 200).cwiseAbs().maxCoeff();
  EXPECT_GT(after, 5.0 * before);
}

}  // namespace
}  // namespace fatmc
