// Effects of gyros and gusts, each against an exact case of its physics.
#include "tests/unit/flight/effect_flights.h"

namespace fatmc {
namespace {

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

TEST(Turbulence, ScalesTheGusts) {
  FlightSetup setup;
  setup.turbulence_m_s = 0.5;
  FlightSetup twice = setup;
  twice.turbulence_m_s = 1.0;
  const Eigen::MatrixX3d still = Eigen::MatrixX3d::Zero(200, 3);
  EXPECT_EQ(fly(with({"turbulence:factor=2"}, setup), still).output, fly({fat(), twice}, still).output);
}

}  // namespace
}  // namespace fatmc
