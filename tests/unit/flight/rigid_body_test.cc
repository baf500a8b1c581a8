// Exact cases of the equations of motion.
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "core/flight/trim.h"
#include "tests/unit/flight/fat.h"

namespace fatmc {
namespace {

/// The FAT in a vacuum: no air forces, no thrust.
Aircraft in_vacuum() {
  Aircraft a = fat();
  a.lift = a.pitch = {};
  a.side = a.roll = a.yaw = {};
  a.drag_zero = a.drag_induced = 0.0;
  a.propulsion.thrust = {};
  return a;
}

State<double> tumbling() {
  State<double> x{};
  x[0] = 1.0;
  x[state::velocity] = 20.0;
  x[state::velocity + 1] = -3.0;
  x[state::velocity + 2] = 5.0;
  x[state::rates] = 1.1;
  x[state::rates + 1] = 2.3;
  x[state::rates + 2] = -0.7;
  x[state::propeller] = 60.0;
  return x;
}

Eigen::Vector3d part(const State<double>& x, std::size_t at) { return {x[at], x[at + 1], x[at + 2]}; }

Eigen::Matrix3d inertia(const Aircraft& a) {
  Eigen::Matrix3d out;
  out << a.ixx_kg_m2, 0, -a.ixz_kg_m2, 0, a.iyy_kg_m2, 0, -a.ixz_kg_m2, 0, a.izz_kg_m2;
  return out;
}

Eigen::Quaterniond attitude(const State<double>& x) { return {x[0], x[1], x[2], x[3]}; }

void advance(const Aircraft& a, State<double>& x, double h, int steps) {
  const FlightConstants k(a);
  for (int i = 0; i < steps; ++i) rk4_step(k, Demand<double>{}, Gust<double>{}, h, x);
}

TEST(RigidBody, ATorqueFreeSpinKeepsAngularMomentumInSpaceAndEnergy) {
  const Aircraft a = in_vacuum();
  const Eigen::Matrix3d body = inertia(a);
  State<double> x = tumbling();
  const Eigen::Vector3d momentum = attitude(x) * (body * part(x, state::rates));
  const double energy = part(x, state::rates).dot(body * part(x, state::rates));
  advance(a, x, 0.001, 10000);
  EXPECT_LT((attitude(x) * (body * part(x, state::rates)) - momentum).norm(), 1e-9 * momentum.norm());
  EXPECT_NEAR(part(x, state::rates).dot(body * part(x, state::rates)), energy, 1e-10 * energy);
  EXPECT_NEAR(attitude(x).norm(), 1.0, 1e-14);
}

TEST(RigidBody, FreeFallFollowsTheParabolaWhileTumbling) {
  const Aircraft a = in_vacuum();
  State<double> x = tumbling();
  const Eigen::Vector3d v0 = attitude(x) * part(x, state::velocity);
  advance(a, x, 0.001, 3000);
  const double t = 3.0;
  const Eigen::Vector3d v = attitude(x) * part(x, state::velocity);
  EXPECT_LT((v - (v0 + Eigen::Vector3d(0, 0, kGravity * t))).norm(), 1e-8);
  EXPECT_NEAR(x[state::height], -v0.z() * t - 0.5 * kGravity * t * t, 1e-8);
}

TEST(RigidBody, FlightWithLiftButWithoutDragKeepsItsEnergy) {
  Aircraft a = fat();
  a.drag_zero = a.drag_induced = 0.0;
  a.side = {};
  a.propulsion.thrust = {};
  a.propulsion.offset_m = 0.0;
  a.roll = a.yaw = {};
  a.pitch.q =
      0.0;  // damping takes energy; C_m_alpha gives it, so the body's rotation is left out of the balance ...
  a.pitch.alpha = a.pitch.zero = a.pitch.eta = 0.0;  // ... by having no moments at all
  State<double> x{};
  x[0] = 1.0;
  x[state::velocity] = 30.0;
  x[state::velocity + 1] = 2.0;
  x[state::velocity + 2] = 1.0;
  x[state::rates] = 0.3;
  x[state::propeller] = 60.0;
  const auto energy = [&](const State<double>& at) {
    return 0.5 * part(at, state::velocity).squaredNorm() + kGravity * at[state::height];
  };
  const double before = energy(x);
  advance(a, x, 0.001, 4000);
  EXPECT_NEAR(energy(x), before, 1e-9 * before);
  EXPECT_GT(std::abs(x[state::height]), 1.0);  // there was something to exchange
}

TEST(RigidBody, RungeKuttaConvergesWithTheFourthOrder) {
  const Aircraft& a = fat();
  const Trim trim = trim_level(a);
  const FlightConstants k(a);
  const auto fly = [&](int steps) {
    State<double> x = trim.state;
    x[state::rates] = 0.4;
    x[state::rates + 1] = 0.3;
    x[state::velocity + 1] = 2.0;
    Gust<double> gust;
    gust.velocity = {0.5, -1.0, 0.7};
    for (int i = 0; i < steps; ++i) rk4_step(k, trim.demand, gust, 1.0 / steps, x);
    return x;
  };
  const State<double> exact = fly(4096);
  const auto error = [&](int steps) {
    const State<double> x = fly(steps);
    double sum = 0.0;
    for (std::size_t i = 0; i <= state::height; ++i) sum += (x[i] - exact[i]) * (x[i] - exact[i]);
    return std::sqrt(sum);
  };
  const double order = std::log2(error(128) / error(256));
  EXPECT_NEAR(order, 4.0, 0.15);
}

TEST(RigidBody, TheQuaternionOfBankAndPitchReturnsThem) {
  State<double> x{};
  const auto q = quaternion_of(0.7, -0.4);
  std::copy(q.begin(), q.end(), x.begin());
  EXPECT_NEAR(euler_of(x)[0], 0.7, 1e-14);
  EXPECT_NEAR(euler_of(x)[1], -0.4, 1e-14);
}

TEST(Atmosphere, DensityIsThatOfTheStandardAtmosphere) {
  EXPECT_NEAR(isa_density(0.0), 1.2250, 5e-5);     // ISO 2533
  EXPECT_NEAR(isa_density(5000.0), 0.7361, 1e-4);  // geopotential height, U.S. Standard Atmosphere 1976
  EXPECT_NEAR(isa_density(610.0), 1.1549, 1e-4);
}

}  // namespace
}  // namespace fatmc
