// Effects of mass, geometry and derivatives, each against an exact case of its physics.
#include "tests/unit/flight/effect_flights.h"

namespace fatmc {
namespace {

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

}  // namespace
}  // namespace fatmc
