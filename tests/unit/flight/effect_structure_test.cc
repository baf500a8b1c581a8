// Effects with states of their own and moments of higher order, each against an exact case of its physics.
#include "tests/unit/flight/effect_flights.h"

namespace fatmc {
namespace {

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

TEST(Slosh, OfATankTiltedAtRestLiesDownhillAndWeighsThere) {
  // A body so heavy that the liquid does not move it, tilted by 20 degrees to the right, nose up by 5, on a stand that carries
  // it: the specific force is minus gravity.
  Aircraft a = fat();
  a.ixx_kg_m2 *= 1e9;
  a.iyy_kg_m2 *= 1e9;
  a.izz_kg_m2 *= 1e9;
  a.ixz_kg_m2 = 0.0;
  a.additional.slosh = {
      .mass_kg = 2.0, .frequency_hz = 0.5, .damping = 0.05, .forward_m = 0.4, .down_m = 0.1};
  const FlightConstants k(a);
  const double phi = 20.0 * kDegree, theta = 5.0 * kDegree, w = 2.0 * kPi * 0.5;
  const std::array<double, 3> gravity = {-kGravity * std::sin(theta),
                                         kGravity * std::sin(phi) * std::cos(theta),
                                         kGravity * std::cos(phi) * std::cos(theta)};
  std::array<double, 3> force{};
  for (std::size_t i = 0; i < 3; ++i) force[i] = -gravity[i] / k.inverse_mass;
  std::array<double, state::extended_size> x{}, dx{};
  const double downhill = gravity[1] / (w * w);  // where the spring holds the weight
  x[state::slosh] = downhill;
  AdditionalDynamics(a, k, true).react(k, x, force, dx);
  EXPECT_GT(downhill, 0.3);
  EXPECT_NEAR(dx[state::slosh + 1], 0.0, 1e-6);  // the body's own motion, a billionth
  EXPECT_NEAR(dx[state::rates] / k.inverse_xx, 2.0 * gravity[2] * downhill, 1e-5);  // to the right
  EXPECT_NEAR(dx[state::rates + 2] / k.inverse_zz, -2.0 * gravity[0] * downhill, 1e-5);
}

TEST(EffectOrder, QuadraticDampingIsAShareOfWhatTheEffectsBeforeHaveLeft) {
  const auto coefficient = [](std::initializer_list<std::string_view> effects) {
    return with(effects, {}).aircraft.additional.quadratic_damping[0];
  };
  constexpr std::string_view damping = "quadratic_damping:axis=roll,ratio=0.5", linear = "cl_p:factor=0.8";
  EXPECT_NEAR(coefficient({linear, damping}), 0.8 * coefficient({damping, linear}), 1e-12);
  EXPECT_NE(coefficient({damping}), 0.0);
}

TEST(EffectOrder, AMisalignmentTurnsTheScaleErrorsGivenBeforeIt) {
  constexpr std::string_view scale = "gyro_scale:axis=roll,error=0.1",
                             turn = "gyro_misalignment:axis=yaw,angle_deg=6";
  const Imu first = with({scale, turn}, {}).setup.imu, last = with({turn, scale}, {}).setup.imu;
  const double c = std::cos(6.0 * kDegree), s = std::sin(6.0 * kDegree);
  EXPECT_NEAR(first.misalignment_rad[0], 1.1 * s, 1e-12);
  EXPECT_NEAR(first.scale_error[0], 1.1 * c - 1.0, 1e-12);
  EXPECT_NEAR(last.misalignment_rad[0], s, 1e-12);
  EXPECT_NEAR(last.scale_error[0], c - 1.0 + 0.1, 1e-12);
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
