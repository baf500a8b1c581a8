// Each effect against an exact case of its physics.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>

#include "core/flight/effects/effect.h"
#include "tests/unit/flight/fat.h"

namespace fatmc {
namespace {

using Complex = std::complex<double>;
using Plant = FlightSetup::Plant;

constexpr double kDegree = kPi / 180.0;

ModifiedFlight with(std::initializer_list<std::string_view> texts, const FlightSetup& setup) {
  std::vector<Effect> effects;
  for (const std::string_view text : texts) {
    Result<Effect> effect = parse_effect(text);
    EXPECT_TRUE(effect.has_value()) << text << ": " << effect.error().text();
    effects.push_back(std::move(*effect));
  }
  const Result<ModifiedFlight> modified = apply(fat(), setup, effects);
  EXPECT_TRUE(modified.has_value()) << modified.error().text();
  return *modified;
}

FlightRecord fly(const ModifiedFlight& modified, const Eigen::MatrixX3d& r) {
  const Result<Flight> flight = Flight::prepare(modified.aircraft, modified.setup);
  EXPECT_TRUE(flight.has_value()) << flight.error().text();
  FlightRecord record;
  flight->fly(r, TrialSeed{1, 2, 3, 4}, record);
  return record;
}

FlightSetup open_loop() {
  FlightSetup setup;
  setup.closed_loop = false;
  return setup;
}

Eigen::MatrixX3d waves(Eigen::Index ticks, double amplitude) {
  Eigen::MatrixX3d r(ticks, 3);
  for (Eigen::Index t = 0; t < ticks; ++t) {
    const double s = 0.02 * static_cast<double>(t);
    r.row(t) << amplitude * std::sin(3.0 * s), amplitude * std::sin(4.0 * s), amplitude * std::sin(5.0 * s);
  }
  return r;
}

Eigen::MatrixX3d later(const Eigen::MatrixX3d& r, Eigen::Index ticks) {
  Eigen::MatrixX3d out = Eigen::MatrixX3d::Zero(r.rows(), 3);
  out.bottomRows(r.rows() - ticks) = r.topRows(r.rows() - ticks);
  return out;
}

/// Amplitude of exp(j 2 pi f t) in x over a whole number of periods from tick `from` on.
Complex component(const Eigen::VectorXd& x, double frequency_hz, Eigen::Index from) {
  Complex sum = 0.0;
  for (Eigen::Index t = from; t < x.size(); ++t) {
    sum += x[t] * std::polar(1.0, -2.0 * kPi * frequency_hz * 0.02 * static_cast<double>(t));
  }
  return 2.0 * sum / static_cast<double>(x.size() - from);
}

Eigen::MatrixX3d sine(int axis, double frequency_hz, double amplitude, Eigen::Index ticks) {
  Eigen::MatrixX3d r = Eigen::MatrixX3d::Zero(ticks, 3);
  for (Eigen::Index t = 0; t < ticks; ++t) {
    r(t, axis) = amplitude * std::sin(2.0 * kPi * frequency_hz * 0.02 * static_cast<double>(t));
  }
  return r;
}

LinearModel linear(const ModifiedFlight& modified) {
  return linearize(modified.aircraft, trim_level(modified.aircraft));
}

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

TEST(Inertia, DividesTheHighFrequencyGain) {
  for (int axis = 0; axis < 3; ++axis) {
    const std::string id = std::string("inertia:axis=") + (axis == 0 ? "roll" : axis == 1 ? "pitch" : "yaw");
    const LinearModel plain = linear({fat(), {}});
    const LinearModel heavy = linear(with({id + ",factor=1.25"}, {}));
    // Rows of dw/dt: the moment is the same, the acceleration 1.25 times smaller (but for the product ixz).
    const int row = 3 + axis;
    const int surface = axis == 0 ? 10 : 11;
    EXPECT_NEAR(plain.a(row, surface) / heavy.a(row, surface), 1.25, 2e-3) << id;
  }
}

TEST(Mass, TrimsAtAsMuchMoreLiftAndTheRecordShowsItsElevator) {
  const Trim plain = trim_level(fat());
  const ModifiedFlight heavy = with({"mass:factor=1.2"}, {});
  const Trim trim = trim_level(heavy.aircraft);
  const double pressure_area = 0.5 * isa_density(610.0) * 24.0 * 24.0 * fat().wing_area_m2;
  const auto lift = [&](const Trim& t) {
    const LongitudinalDerivatives& c = fat().lift;
    return (c.zero + c.alpha * t.alpha_rad + c.eta * t.eta_rad) * pressure_area;
  };
  // Vertical balance: L + T sin(alpha) = m g (level flight, thrust along x).
  EXPECT_NEAR(lift(trim) + trim.thrust_n * std::sin(trim.alpha_rad), 1.2 * 23.0 * kGravity, 1e-8);
  EXPECT_NEAR(lift(plain) + plain.thrust_n * std::sin(plain.alpha_rad), 23.0 * kGravity, 1e-8);

  // No reference, no gusts: the aircraft stays where its pilot has trimmed it, and the record says how.
  const FlightRecord record = fly(heavy, Eigen::MatrixX3d::Zero(500, 3));
  const double offset = (plain.eta_rad - trim.eta_rad) / fat().full_command_rad;
  EXPECT_GT(std::abs(offset), 1e-3);
  EXPECT_LT((record.input.col(1).array() - offset).abs().maxCoeff(), 1e-9);
  EXPECT_LT((record.auxiliary.col(1).array() - trim.alpha_rad).abs().maxCoeff(), 1e-9);
  EXPECT_LT(record.output.cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_GT(trim.alpha_rad - plain.alpha_rad, 0.02);
}

TEST(CentreOfGravity, ForwardAddsItsShareOfTheChordToTheStaticMargin) {
  // dM/dalpha = -shift dF_z-arm: C_m_alpha' = C_m_alpha - (shift/c) (C_L_alpha + C_D + ...), to first order in alpha.
  const double shift = 0.01;
  const ModifiedFlight forward = with({"cg_shift:direction=forward,shift_m=0.01"}, {});
  const Trim trim = trim_level(fat());
  const auto cm_alpha = [&](const Aircraft& a) {
    const double h = 1e-6;
    const auto pitching = [&](double alpha) {
      State<double> x = trim.state;
      x[state::velocity] = 24.0 * std::cos(alpha);
      x[state::velocity + 2] = 24.0 * std::sin(alpha);
      State<double> dx;
      const FlightConstants k(a);
      if (a.additional == AdditionalPhysics{}) {
        derivative(k, x, trim.demand, Gust<double>{}, dx);
      } else {
        derivative(k, x, trim.demand, Gust<double>{}, dx, AdditionalDynamics(a, k, false));
      }
      return dx[state::rates + 1];
    };
    const double per_unit = 0.5 * isa_density(610.0) * 576.0 * a.wing_area_m2 * a.chord_m / a.iyy_kg_m2;
    return (pitching(trim.alpha_rad + h) - pitching(trim.alpha_rad - h)) / (2.0 * h * per_unit);
  };
  // F_z = -(L cos alpha + D sin alpha), M = +shift F_z: C_N = C_L cos + C_D sin, differentiated at trim.
  const LongitudinalDerivatives& lift = fat().lift;
  const double cl = lift.zero + lift.alpha * trim.alpha_rad + lift.eta * trim.eta_rad;
  const double cd = fat().drag_zero + fat().drag_induced * cl * cl;
  const double s = std::sin(trim.alpha_rad);
  const double c = std::cos(trim.alpha_rad);
  const double cn_alpha = lift.alpha * c - cl * s + 2.0 * fat().drag_induced * cl * lift.alpha * s + cd * c;
  EXPECT_NEAR(cm_alpha(forward.aircraft) - cm_alpha(fat()), -shift / fat().chord_m * cn_alpha, 1e-6);
  // Up elevator (negative command offset is positive deflection...): the nose is heavier by shift times the weight.
  const Trim moved = trim_level(forward.aircraft);
  EXPECT_LT(moved.eta_rad, trim.eta_rad);
}

TEST(CentreOfGravity, OfAFreeBodyMovesNothingButTheMoment) {
  // The force is that of the reference point; the moment differs by r x F exactly.
  const ModifiedFlight down = with({"cg_shift:direction=down,shift_m=0.02"}, {});
  const Trim trim = trim_level(fat());
  State<double> x = trim.state;
  x[state::velocity + 1] = 1.5;
  State<double> a, b;
  const FlightConstants k(fat());
  derivative(k, x, trim.demand, Gust<double>{}, a);
  derivative(k, x, trim.demand, Gust<double>{}, b, AdditionalDynamics(down.aircraft, k, false));
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(a[state::velocity + i], b[state::velocity + i], 1e-12);
  const double side_force = 23.0 * (a[state::velocity + 1] - kGravity * down_in_body(x)[1]);
  // r_A = (0, 0, -0.02): M_x = -r_z F_y.
  const double roll = (b[state::rates] - a[state::rates]) / k.inverse_xx;
  EXPECT_NEAR(roll, 0.02 * side_force, 1e-9);
}

TEST(Derivatives, AreMultipliedOneByOne) {
  EXPECT_EQ(with({"cm_alpha:factor=1.2"}, {}).aircraft.pitch.alpha, 1.2 * fat().pitch.alpha);
  EXPECT_EQ(with({"cl_p:factor=0.7"}, {}).aircraft.roll.p, 0.7 * fat().roll.p);
  EXPECT_EQ(with({"cn_r:factor=2"}, {}).aircraft.yaw.r, 2.0 * fat().yaw.r);
  EXPECT_EQ(with({"cn_r:factor=2", "cn_r:factor=0.5"}, {}).aircraft.yaw.r, fat().yaw.r);
  Aircraft wanted = fat();
  wanted.yaw.beta *= 0.9;
  EXPECT_TRUE(with({"cn_beta:factor=0.9"}, {}).aircraft == wanted) << "and nothing else changes";
}

TEST(AirspeedError, FliesAtAnotherSpeedThanTheRecordSays) {
  const FlightRecord record = fly(with({"airspeed_error:factor=1.1"}, {}), Eigen::MatrixX3d::Zero(200, 3));
  EXPECT_LT((record.auxiliary.col(2).array() - 24.0).abs().maxCoeff(), 1e-9);
  const Trim faster = [] {
    Aircraft a = fat();
    a.speed_m_s *= 1.1;
    return trim_level(a);
  }();
  EXPECT_LT((record.auxiliary.col(1).array() - faster.alpha_rad).abs().maxCoeff(), 1e-9);
}

TEST(PropellerGyroscopics, CouplesPitchAndYawAntisymmetrically) {
  const ModifiedFlight modified = with({"propeller_gyroscopics:inertia_kg_m2=0.02"}, {});
  const LinearModel plain = linear({fat(), {}});
  const LinearModel turning = linear(modified);
  const double h = 2.0 * kPi * trim_level(fat()).propeller_hz * 0.02;
  EXPECT_NEAR(turning.a(4, 5) - plain.a(4, 5), -h / fat().iyy_kg_m2, 1e-9);
  const double izz = FlightConstants(fat()).inverse_zz;
  EXPECT_NEAR(turning.a(5, 4) - plain.a(5, 4), h * izz, 1e-9);
}

TEST(Coupling, OfTheAileronAddsYawInProportionToRoll) {
  const Aircraft a = with({"roll_to_yaw_coupling:ratio=0.05"}, {}).aircraft;
  EXPECT_DOUBLE_EQ(a.yaw.xi, fat().yaw.xi + 0.05 * fat().roll.xi);
  const Aircraft b = with({"yaw_to_roll_coupling:ratio=0.5"}, {}).aircraft;
  EXPECT_DOUBLE_EQ(b.roll.zeta, fat().roll.zeta + 0.5 * fat().yaw.zeta);
}

TEST(GyroLag, IsAFirstOrderLag) {
  // Sine at the excited axis, linear plant: measured over true rate = L(z), and L is near 1/(T j w + 1).
  const double f = 1.0;
  const double time_constant = 0.05;
  FlightSetup setup = open_loop();
  setup.plant = Plant::linear;
  const Eigen::MatrixX3d u = sine(0, f, 0.01, 3000);
  const Complex plain = component(fly({fat(), setup}, u).output.col(0), f, 2000);
  const Complex lagged =
      component(fly(with({"gyro_lag:time_constant_s=0.05"}, setup), u).output.col(0), f, 2000);
  const Complex z = std::polar(1.0, 2.0 * kPi * f * 0.02);
  const double a = std::exp(-0.02 / time_constant);
  const double ramp = time_constant / 0.02 * (1.0 - a);
  const Complex exact = ((1.0 - ramp) * z + ramp - a) / (z - a);
  EXPECT_LT(std::abs(lagged / plain - exact), 1e-4);
  EXPECT_LT(std::abs(exact - 1.0 / Complex(1.0, 2.0 * kPi * f * time_constant)), 2e-3);
}

TEST(GyroErrors, ScaleRotateShiftAndRound) {
  FlightSetup setup = open_loop();
  const Eigen::MatrixX3d u = waves(300, 0.02);
  const Eigen::MatrixX3d plain = fly({fat(), setup}, u).output;
  const Eigen::MatrixX3d scaled = fly(with({"gyro_scale:axis=pitch,error=0.1"}, setup), u).output;
  EXPECT_LT((scaled.col(1) - 1.1 * plain.col(1)).cwiseAbs().maxCoeff(), 1e-15);
  EXPECT_EQ(scaled.col(0), plain.col(0));
  const Eigen::MatrixX3d turned = fly(with({"gyro_misalignment:axis=yaw,angle_deg=5"}, setup), u).output;
  const double c = std::cos(5.0 * kDegree);
  const double s = std::sin(5.0 * kDegree);
  EXPECT_LT((turned.col(0) - (c * plain.col(0) + s * plain.col(1))).cwiseAbs().maxCoeff(), 1e-14);
  EXPECT_LT((turned.col(1) - (c * plain.col(1) - s * plain.col(0))).cwiseAbs().maxCoeff(), 1e-14);
  EXPECT_EQ(turned.col(2), plain.col(2));
  const Eigen::MatrixX3d biased = fly(with({"gyro_bias:axis=roll,bias_deg_s=1"}, setup), u).output;
  EXPECT_LT((biased.col(0).array() - plain.col(0).array() - kDegree).abs().maxCoeff(), 1e-14);
  const Eigen::MatrixX3d coarse = fly(with({"gyro_quantisation:step_deg_s=0.5"}, setup), u).output;
  const Eigen::MatrixX3d steps = coarse / (0.5 * kDegree);
  EXPECT_LT((steps.array() - steps.array().round()).abs().maxCoeff(), 1e-9);
  EXPECT_LE((coarse - plain).cwiseAbs().maxCoeff(), 0.25 * kDegree + 1e-12);
}

TEST(GyroNoise, GrowsByItsFactor) {
  FlightSetup setup = open_loop();
  setup.imu.noise_rad_sqrt_s = 1e-4;
  const Eigen::MatrixX3d still = Eigen::MatrixX3d::Zero(400, 3);
  const Eigen::MatrixX3d one = fly({fat(), setup}, still).output;
  const Eigen::MatrixX3d four = fly(with({"gyro_noise:factor=4"}, setup), still).output;
  EXPECT_LT((four - 4.0 * one).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(Tone, AddsASinusoidToOneGyro) {
  const FlightRecord record =
      fly(with({"tone:axis=yaw,amplitude_deg_s=0.5,frequency_hz=1,phase_deg=90"}, open_loop()),
          Eigen::MatrixX3d::Zero(500, 3));
  EXPECT_NEAR(std::abs(component(record.output.col(2), 1.0, 0)), 0.5 * kDegree, 1e-9);
  EXPECT_NEAR(record.output(0, 2), 0.5 * kDegree, 1e-12);
  EXPECT_LT(record.output.leftCols(2).cwiseAbs().maxCoeff(), 1e-9);
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

TEST(Turbulence, ScalesTheGusts) {
  FlightSetup setup;
  setup.turbulence_m_s = 0.5;
  FlightSetup twice = setup;
  twice.turbulence_m_s = 1.0;
  const Eigen::MatrixX3d still = Eigen::MatrixX3d::Zero(200, 3);
  EXPECT_EQ(fly(with({"turbulence:factor=2"}, setup), still).output, fly({fat(), twice}, still).output);
}

TEST(FlexibleMode, AddsItsTransferFunctionToTheGyro) {
  // Rate gyro: -k w^2 s/(s^2 + 2 z w s + w^2) of the deflection; at resonance k w/(2 z). Open loop, the rigid
  // body's answer taken away.
  const double k = 0.01;
  const double z = 0.05;
  const double f_mode = 1.5;
  const double w = 2.0 * kPi * f_mode;
  FlightSetup setup = open_loop();
  setup.step_s = 0.005;
  for (const double f : {1.0, 1.5, 2.0}) {
    const Eigen::MatrixX3d u = sine(1, f, 0.01, 6000);
    const FlightRecord plain = fly({fat(), setup}, u);
    const FlightRecord bent =
        fly(with({"flexible_mode:axis=pitch,slope=0.01,frequency_hz=1.5,damping=0.05"}, setup), u);
    const Complex added = component(bent.output.col(1), f, 5000) - component(plain.output.col(1), f, 5000);
    const Complex s(0.0, 2.0 * kPi * f);
    const Complex servo = 1600.0 / (s * s + 72.0 * s + 1600.0);
    // Held for a tick: sinc and half a tick of delay.
    const double half = 2.0 * kPi * f * 0.01;
    const Complex hold = std::polar(std::sin(half) / half, -half);
    const Complex deflection = -fat().full_command_rad * 0.01 * Complex(0.0, -1.0) * servo * hold;
    const Complex wanted = -k * w * w * s / (s * s + 2.0 * z * w * s + w * w) * deflection;
    EXPECT_LT(std::abs(added - wanted), 2e-3 * std::abs(wanted)) << f;
  }
}

TEST(FlexibleMode, RingsAtItsFrequencyAndDecaysWithItsDamping) {
  FlightSetup setup = open_loop();
  setup.step_s = 0.005;
  Eigen::MatrixX3d u = Eigen::MatrixX3d::Zero(400, 3);
  u.block(0, 1, 10, 1).setConstant(0.02);
  const Eigen::VectorXd ring =
      fly(with({"flexible_mode:axis=pitch,slope=0.02,frequency_hz=1.2,damping=0.02"}, setup), u)
          .output.col(1) -
      fly({fat(), setup}, u).output.col(1);
  // x[n+1] + x[n-1] = 2 exp(-z w T) cos(w_d T) x[n] after scaling: fit by least squares once the servo rests.
  Eigen::MatrixX2d past(300, 2);
  past << ring.segment(80, 300), ring.segment(79, 300);
  const Eigen::Vector2d fit = (past.transpose() * past).inverse() * past.transpose() * ring.segment(81, 300);
  const Complex root = 0.5 * (fit[0] + std::sqrt(Complex(fit[0] * fit[0] + 4.0 * fit[1])));
  const Complex pole = std::log(root) / 0.02;
  EXPECT_NEAR(std::abs(pole) / (2.0 * kPi), 1.2, 1.2e-3);
  EXPECT_NEAR(-pole.real() / std::abs(pole), 0.02, 2e-4);
}

TEST(Slosh, OfALiquidOnAStiffSpringIsTheFrozenOne) {
  // At 10 Hz with much damping the liquid moves with the tank.
  const Eigen::MatrixX3d u = waves(500, 0.02);
  const FlightRecord frozen = fly({fat(), open_loop()}, u);
  const FlightRecord stiff =
      fly(with({"slosh:mass_kg=2,frequency_hz=10,damping=0.7,forward_m=0.3,down_m=0.1"}, open_loop()), u);
  const FlightRecord soft =
      fly(with({"slosh:mass_kg=2,frequency_hz=0.5,damping=0.05,forward_m=0.3,down_m=0.1"}, open_loop()), u);
  const double scale = frozen.output.col(2).cwiseAbs().maxCoeff();
  EXPECT_LT((stiff.output - frozen.output).col(2).cwiseAbs().maxCoeff(), 3e-3 * scale);
  EXPECT_GT((soft.output - frozen.output).col(2).cwiseAbs().maxCoeff(), 3e-2 * scale);
}

TEST(Slosh, ConservesMomentumAndEnergyOfFreeBodyAndLiquid) {
  // No damping, no outer force: a body of mass m - m_s and inertia I less that of m_s, and a point m_s on a spring.
  Aircraft a = fat();
  a.ixz_kg_m2 = 0.0;
  a.additional.slosh = {.mass_kg = 3.0, .frequency_hz = 0.7, .damping = 0.0, .forward_m = 0.4, .down_m = 0.0};
  const FlightConstants k(a);
  const AdditionalDynamics dynamics(a, k, true);
  std::array<double, state::extended_size> x{};
  x[state::slosh] = 0.1;
  std::array<double, state::extended_size> dx{};
  dynamics.react(k, x, {0.0, 0.0, 0.0}, dx);
  const double w2 = std::pow(2.0 * kPi * 0.7, 2);
  const double spring = 3.0 * w2 * 0.1;
  // Linear momentum: (m - m_s) of the shell, whose centre lies aft, and the liquid. With v the acceleration of the
  // frozen centre of gravity: shell total = m v - m_s (v + x r'), force on it = spring.
  const double v = dx[state::velocity + 1];
  const double r = dx[state::rates + 2];
  EXPECT_NEAR(23.0 * v - 3.0 * (v + 0.4 * r), spring, 1e-12);
  EXPECT_NEAR(a.izz_kg_m2 * r - 0.4 * 3.0 * (v + 0.4 * r), 0.4 * spring, 1e-12);
  // The liquid against inertial space: m_s (a + y'') = -spring.
  EXPECT_NEAR(3.0 * (v + 0.4 * r + dx[state::slosh + 1]), -spring, 1e-12);
}

TEST(QuadraticDamping, IsItsShareOfTheLinearOneAtTheReferenceRate) {
  const ModifiedFlight modified = with({"quadratic_damping:axis=roll,ratio=0.5"}, {});
  const Trim trim = trim_level(fat());
  State<double> x = trim.state;
  x[state::rates] = 0.1;
  State<double> still, rolling, damped;
  const FlightConstants k(fat());
  derivative(k, trim.state, trim.demand, Gust<double>{}, still);
  derivative(k, x, trim.demand, Gust<double>{}, rolling);
  derivative(k, x, trim.demand, Gust<double>{}, damped, AdditionalDynamics(modified.aircraft, k, false));
  const double linear_part = 0.5 * isa_density(610.0) * 576.0 * 1.1 * 5.0 * fat().roll.p * 0.1 * 5.0 / 48.0;
  EXPECT_NEAR((damped[state::rates] - rolling[state::rates]) / k.inverse_xx, 0.5 * linear_part,
              1e-9 * std::abs(linear_part));
}

TEST(CubicMoment, IsItsShareOfTheLinearOneAtOneDegreeFromTrim) {
  const ModifiedFlight modified = with({"cubic_moment:axis=pitch,ratio=0.5"}, {});
  const Trim trim = trim_level(fat());
  EXPECT_NEAR(trim_level(modified.aircraft).alpha_rad, trim.alpha_rad, 1e-12) << "trim is not moved";
  State<double> x = trim.state;
  x[state::velocity] = 24.0 * std::cos(trim.alpha_rad + kDegree);
  x[state::velocity + 2] = 24.0 * std::sin(trim.alpha_rad + kDegree);
  State<double> plain, cubic;
  const FlightConstants k(fat());
  derivative(k, x, trim.demand, Gust<double>{}, plain);
  derivative(k, x, trim.demand, Gust<double>{}, cubic, AdditionalDynamics(modified.aircraft, k, false));
  const double static_part =
      0.5 * isa_density(610.0) * 576.0 * 1.1 * 0.22 * fat().pitch.alpha * kDegree / fat().iyy_kg_m2;
  EXPECT_NEAR(cubic[state::rates + 1] - plain[state::rates + 1], 0.5 * static_part,
              1e-9 * std::abs(static_part));
}

}  // namespace
}  // namespace fatmc
