// Effects between controller and surface, each against an exact case of its physics.
#include "tests/unit/flight/effect_flights.h"

namespace fatmc {
namespace {

TEST(TransportDelay, OfWholeTicksShiftsTheCommandByThem) {
  const Eigen::MatrixX3d u = waves(600, 0.02);
  for (const Plant plant : {Plant::nonlinear, Plant::linear}) {
    FlightSetup setup = open_loop();
    setup.plant = plant;
    const FlightRecord delayed = fly(with({"transport_delay:delay_s=0.06"}, setup), u);
    const FlightRecord shifted = fly({fat(), setup}, later(u, 3));
    EXPECT_LT((delayed.output - shifted.output).cwiseAbs().maxCoeff(), 1e-15);
    EXPECT_EQ(delayed.input, u) << "the record holds the controller's command";
  }
}

TEST(TransportDelay, OfATickAndAHalfIsThatOfThreeTicksAtTwiceTheRate) {
  // At 100 Hz, 0.03 s are three ticks, and a command held for 0.02 s is one held for two of them.
  const Eigen::MatrixX3d u = waves(400, 0.02);
  Eigen::MatrixX3d twice(800, 3);
  for (Eigen::Index t = 0; t < 800; ++t) twice.row(t) = u.row(t / 2);
  for (const Plant plant : {Plant::nonlinear, Plant::linear}) {
    FlightSetup setup = open_loop();
    setup.plant = plant;
    FlightSetup fast = setup;
    fast.rate_hz = 100.0;
    fast.step_s = fast.imu_step_s = 0.01;
    const FlightRecord exact = fly(with({"transport_delay:delay_s=0.03"}, fast), twice);
    const FlightRecord delayed = fly(with({"transport_delay:delay_s=0.03"}, setup), u);
    double gap = 0.0;
    for (Eigen::Index t = 0; t < 400; ++t) {
      gap = std::max(gap, (delayed.output.row(t) - exact.output.row(2 * t)).cwiseAbs().maxCoeff());
    }
    EXPECT_LT(gap, 1e-13);
  }
}

TEST(ControlEffectiveness, ScalesTheColumnOfItsControlAndNothingElse) {
  const LinearModel plain = linear({fat(), {}});
  const char* axes[] = {"roll", "pitch", "yaw"};
  for (int axis = 0; axis < 3; ++axis) {
    const LinearModel scaled =
        linear(with({std::string("control_effectiveness:axis=") + axes[axis] + ",factor=0.8"}, {}));
    for (const double f : {0.3, 1.0, 2.5}) {
      Eigen::Matrix3cd wanted = plain.response(f);
      wanted.col(axis) *= 0.8;
      EXPECT_LT((scaled.response(f) - wanted).norm(), 1e-10 * wanted.norm()) << axis;
    }
  }
}

TEST(ServoLimits, HoldTheSurfacesRateAndPlace) {
  const Eigen::MatrixX3d u = sine(0, 1.0, 0.1, 500);  // 4 degrees, 25 deg/s
  const FlightRecord slow = fly(with({"rate_limit:surface=aileron,limit_deg_s=10"}, open_loop()), u);
  EXPECT_GT(slow.at_rate_limit[0], 0.5);
  EXPECT_EQ(slow.at_rate_limit[1], 0.0);
  const FlightRecord shortened = fly(with({"position_limit:surface=aileron,limit_deg=2"}, open_loop()), u);
  EXPECT_GT(shortened.at_position_limit[0], 0.3);
}

TEST(DeadZone, LosesSmallCommandsAndShortensLargeOnes) {
  // Zone of 1 degree: half of it is u = 0.0125.
  const double half = 0.5 * kDegree / fat().full_command_rad;
  Eigen::MatrixX3d u = Eigen::MatrixX3d::Zero(100, 3);
  u.col(1).setConstant(0.9 * half);
  EXPECT_LT(fly(with({"dead_zone:axis=pitch,width_deg=1"}, open_loop()), u).output.cwiseAbs().maxCoeff(),
            1e-12);
  u.col(1).setConstant(0.03);
  Eigen::MatrixX3d shortened = u;
  shortened.col(1).setConstant(0.03 - half);
  const FlightRecord zone = fly(with({"dead_zone:axis=pitch,width_deg=1"}, open_loop()), u);
  EXPECT_LT((zone.output - fly({fat(), open_loop()}, shortened).output).cwiseAbs().maxCoeff(), 1e-15);
}

TEST(Backlash, FollowsTheServoHalfAWidthBehindAndStandsStillWhenItTurns) {
  Aircraft a = fat();
  a.additional.half_play_rad[0] = 0.01;
  AdditionalDynamics play(a, FlightConstants(a), true);
  play.start({0.0, 0.0, 0.0});
  std::array<double, state::extended_size> x{};
  const auto at = [&](double servo) {
    x[state::surfaces] = servo;
    const double surface = play.surface(x, 0);
    play.settle(x);
    return surface;
  };
  EXPECT_EQ(at(0.005), 0.0);
  EXPECT_DOUBLE_EQ(at(0.03), 0.02);
  EXPECT_DOUBLE_EQ(at(0.015), 0.02) << "has turned: the play is crossed first";
  EXPECT_DOUBLE_EQ(at(0.0), 0.01);
  EXPECT_DOUBLE_EQ(at(-0.05), -0.04);
}

TEST(Backlash, OfASineHasTheDescribingFunctionOfPlay) {
  // Surface of a 1 degree sine with 0.5 degrees of whole play, against the classical describing function
  // (N = (b1 + j a1)/A); the roll rate's component goes with it, for a slow sine and a nearly linear response.
  const double f = 0.5;
  const Eigen::MatrixX3d u = sine(0, f, kDegree / fat().full_command_rad, 3000);
  const Complex plain = component(fly({fat(), open_loop()}, u).output.col(0), f, 1000);
  const Complex play =
      component(fly(with({"backlash:surface=aileron,width_deg=0.5"}, open_loop()), u).output.col(0), f, 1000);
  const Result<Flight> flight = Flight::prepare(fat(), open_loop());
  // Amplitude of the servo behind its own lag.
  const Complex s(0.0, 2.0 * kPi * f);
  const double amplitude = std::abs(1600.0 / (s * s + 72.0 * s + 1600.0));
  const double ratio = 0.25 / amplitude;  // half play over amplitude
  const double x = 1.0 - 2.0 * ratio;
  const double b1 = (std::asin(x) + kPi / 2.0 + x * std::sqrt(1.0 - x * x)) / kPi;
  const double a1 = -4.0 * ratio * (1.0 - ratio) / kPi;
  EXPECT_LT(std::abs(play / plain - Complex(b1, a1)), 0.01);
}

TEST(SurfaceBias, ShowsInTheMeanCommandAlone) {
  const Eigen::MatrixX3d r = waves(300, 0.1);
  const FlightRecord plain = fly({fat(), {}}, r);
  const FlightRecord biased = fly(with({"surface_bias:axis=yaw,bias_deg=1"}, {}), r);
  EXPECT_LT((biased.output - plain.output).cwiseAbs().maxCoeff(), 1e-13);
  const double offset = kDegree / fat().full_command_rad;
  EXPECT_LT((biased.input.col(2).array() - plain.input.col(2).array() - offset).abs().maxCoeff(), 1e-15);
}

TEST(LoopGain, MultipliesTheCommandOfItsAxis) {
  const FlightRecord record = fly(with({"loop_gain:axis=pitch,factor=1.5"}, {}), waves(100, 0.1));
  const Eigen::VectorXd wanted = 0.15 * (record.reference.col(1) - record.output.col(1));
  EXPECT_LT((record.input.col(1) - wanted).cwiseAbs().maxCoeff(), 1e-15);
}

TEST(TurnCoordinator, ScalesItsYawCommand) {
  const FlightRecord record = fly(with({"turn_coordinator:factor=0"}, {}), waves(500, 0.3));
  const Eigen::VectorXd wanted = 0.1 * (record.reference.col(2) - record.output.col(2));
  EXPECT_LT((record.input.col(2) - wanted).cwiseAbs().maxCoeff(), 1e-15);
  EXPECT_GT(record.auxiliary.col(0).cwiseAbs().maxCoeff(), 0.01);
}

}  // namespace
}  // namespace fatmc
