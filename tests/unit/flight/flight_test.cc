#include "core/flight/flight.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/flight/fat.h"

namespace fatmc {
namespace {

using Plant = FlightSetup::Plant;

Eigen::MatrixX3d waves(Eigen::Index ticks, double amplitude) {
  Eigen::MatrixX3d r(ticks, 3);
  for (Eigen::Index t = 0; t < ticks; ++t) {
    const double s = 0.02 * static_cast<double>(t);
    r.row(t) << amplitude * std::sin(3.1 * s), amplitude * std::sin(4.3 * s), amplitude * std::sin(2.2 * s);
  }
  return r;
}

FlightRecord fly(const FlightSetup& setup, const Eigen::MatrixX3d& r, std::uint64_t repetition = 0,
                 const Aircraft& aircraft = fat()) {
  const Result<Flight> flight = Flight::prepare(aircraft, setup);
  FATMC_CHECK(flight.has_value(), "the test's setup can be flown");
  FlightRecord record;
  flight->fly(r, TrialSeed{5, 6, 7, repetition}, record);
  return record;
}

FlightSetup windy() {
  FlightSetup setup;
  setup.imu = *fat_model().imu("tactical");
  setup.turbulence_m_s = 1.5;
  return setup;
}

TEST(Flight, WithoutCommandsInCalmAirTrimIsHeld) {
  const FlightRecord record = fly(FlightSetup{}, Eigen::MatrixX3d::Zero(5000, 3));
  EXPECT_EQ(record.ending, Ending::completed);
  EXPECT_EQ(record.samples, 5000);
  EXPECT_LT(record.output.cwiseAbs().maxCoeff(), 1e-10);
  EXPECT_NEAR(record.auxiliary(4999, 2), 24.0, 1e-8);
}

TEST(Flight, TheSameSeedGivesTheSameBitsAndAnotherDoesNot) {
  const Eigen::MatrixX3d r = waves(2000, 0.1);
  const FlightRecord a = fly(windy(), r);
  const FlightRecord b = fly(windy(), r);
  EXPECT_TRUE(a.output == b.output && a.input == b.input && a.auxiliary == b.auxiliary);
  EXPECT_GT((fly(windy(), r, 1).output - a.output).cwiseAbs().maxCoeff(), 1e-3);
}

TEST(Flight, LongitudinalGustsKeepTheAircraftInItsPlaneOfSymmetryExactly) {
  FlightSetup setup;
  setup.turbulence_m_s = 3.0;
  setup.gusts = FlightSetup::Gusts::longitudinal;
  setup.gusts_from_calm = true;
  Eigen::MatrixX3d r = waves(2000, 0.05);
  r.col(0).setZero();
  r.col(2).setZero();
  const FlightRecord record = fly(setup, r);
  EXPECT_EQ(record.ending, Ending::completed);
  EXPECT_GT(record.output.col(1).cwiseAbs().maxCoeff(), 0.05);
  EXPECT_EQ(record.output.col(0).cwiseAbs().maxCoeff(), 0.0);
  EXPECT_EQ(record.output.col(2).cwiseAbs().maxCoeff(), 0.0);
  EXPECT_EQ(record.auxiliary.col(0).cwiseAbs().maxCoeff(), 0.0);
}

TEST(Flight, GustsFromCalmBeginAtZeroAndReachTheirStationaryStrength) {
  FlightSetup setup;
  setup.turbulence_m_s = 1.0;
  setup.gusts_from_calm = true;
  const Eigen::MatrixX3d still = Eigen::MatrixX3d::Zero(20000, 3);
  const FlightRecord calm = fly(setup, still);
  EXPECT_NEAR(calm.auxiliary(0, 2), 24.0, 1e-12);
  setup.gusts_from_calm = false;
  const FlightRecord stationary = fly(setup, still);
  EXPECT_GT(std::abs(stationary.auxiliary(0, 2) - 24.0), 1e-3);
  // Roll rates of the last 200 s scatter alike; their correlation time is below 1 s, so that 200 s give 5 %.
  const double late = calm.output.col(0).tail(10000).norm() / stationary.output.col(0).tail(10000).norm();
  EXPECT_NEAR(late, 1.0, 0.2);
}

TEST(Flight, ARecordThatIsReusedIsOverwritten) {
  const Result<Flight> flight = Flight::prepare(fat(), windy());
  FlightRecord record;
  flight->fly(waves(3000, 0.3), TrialSeed{1, 1, 1, 1}, record);
  flight->fly(waves(2000, 0.1), TrialSeed{5, 6, 7, 0}, record);
  const FlightRecord fresh = fly(windy(), waves(2000, 0.1));
  EXPECT_TRUE(record.output == fresh.output);
  EXPECT_EQ(record.at_rate_limit, fresh.at_rate_limit);
}

TEST(Flight, TheInputIsGainTimesTheErrorOfTheSameTick) {
  FlightSetup setup = windy();
  setup.gain = {0.1, 0.2, 0.3};
  setup.turn_coordinator = false;
  const FlightRecord record = fly(setup, waves(500, 0.1));
  for (int c = 0; c < 3; ++c) {
    const Eigen::VectorXd wanted = setup.gain[c] * (record.reference.col(c) - record.output.col(c));
    EXPECT_LT((record.input.col(c) - wanted).cwiseAbs().maxCoeff(), 1e-15);
  }
}

TEST(Flight, TheTurnCoordinatorAddsTheYawRateOfACoordinatedTurn) {
  FlightSetup setup;
  Eigen::MatrixX3d r = Eigen::MatrixX3d::Zero(500, 3);
  r.col(0).head(100).setConstant(2.0);
  const FlightRecord record = fly(setup, r);
  const Eigen::Index last = 499;
  const double phi = record.auxiliary(last, 0);
  EXPECT_GT(phi, 0.1);
  const double wanted =
      0.1 * (kGravity / record.auxiliary(last, 2) * std::sin(phi) * std::cos(record.auxiliary(last, 1)) -
             record.output(last, 2));
  EXPECT_NEAR(record.input(last, 2), wanted, 1e-12);
}

TEST(Flight, APositiveCommandGivesAPositiveRateOfItsAxis) {
  for (int axis = 0; axis < 3; ++axis) {
    FlightSetup setup;
    setup.closed_loop = false;
    Eigen::MatrixX3d u = Eigen::MatrixX3d::Zero(20, 3);
    u.col(axis).setConstant(0.05);
    EXPECT_GT(fly(setup, u).output(19, axis), 1e-3) << axis;
  }
}

TEST(Flight, LeftAndRightAreMirrorImages) {
  FlightSetup setup;
  const Eigen::MatrixX3d r = waves(3000, 0.3);
  const Eigen::DiagonalMatrix<double, 3> mirror(-1.0, 1.0, -1.0);  // roll and yaw change sign, pitch does not
  const FlightRecord a = fly(setup, r);
  const FlightRecord b = fly(setup, r * mirror);
  EXPECT_TRUE(a.ending == Ending::completed && a.output.col(0).cwiseAbs().maxCoeff() > 0.01);
  EXPECT_LT((a.output * mirror - b.output).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(Flight, AQuarterOfTheStepChangesNextToNothing) {
  // Turbulence and commands are held over the tick whatever the step, so that both fly through the same air.
  FlightSetup fine = windy();
  fine.step_s = 0.005;
  const FlightRecord a = fly(windy(), waves(5000, 0.1));
  const FlightRecord b = fly(fine, waves(5000, 0.1));
  const double scale = a.output.cwiseAbs().maxCoeff();
  EXPECT_LT((a.output - b.output).cwiseAbs().maxCoeff(), 2e-3 * scale);
  EXPECT_GT((a.output - b.output).cwiseAbs().maxCoeff(), 0.0);
}

TEST(Flight, TheNonlinearPlantTendsToTheLinearOneQuadratically) {
  // Deviation from the linear response is of second order in the amplitude: a tenth gives a hundredth.
  FlightSetup nonlinear;
  FlightSetup linear;
  linear.plant = Plant::linear;
  const auto gap = [&](double amplitude) {
    const Eigen::MatrixX3d r = waves(1000, amplitude);
    return (fly(nonlinear, r).output - fly(linear, r).output).cwiseAbs().maxCoeff();
  };
  EXPECT_NEAR(gap(1e-2) / gap(1e-3), 100.0, 15.0);
}

TEST(Flight, GustsEnterTheLinearPlantAsTheyEnterTheNonlinearOne) {
  FlightSetup nonlinear;
  FlightSetup linear;
  linear.plant = Plant::linear;
  const Eigen::MatrixX3d r = Eigen::MatrixX3d::Zero(1000, 3);
  const auto gap = [&](double sigma) {
    nonlinear.turbulence_m_s = linear.turbulence_m_s = sigma;
    return (fly(nonlinear, r).output - fly(linear, r).output).cwiseAbs().maxCoeff();
  };
  EXPECT_NEAR(gap(1e-2) / gap(1e-3), 100.0, 15.0);
}

TEST(Flight, GustsActOnThePlantAndNotOnTheMeasurement) {
  // y[0] is measured before any gust has acted, so that it is exactly trim, while the airspeed already feels
  // the gust.
  FlightSetup setup;
  setup.turbulence_m_s = 1.5;
  const FlightRecord record = fly(setup, Eigen::MatrixX3d::Zero(10, 3));
  EXPECT_LT(record.output.row(0).cwiseAbs().maxCoeff(), 1e-15);
  EXPECT_GT(std::abs(record.auxiliary(0, 2) - 24.0), 1e-3);
  EXPECT_GT(record.output.row(9).cwiseAbs().maxCoeff(), 1e-4);
}

TEST(Flight, TheClosedLoopFollowsTheSampledResponse) {
  // y/r = (I + G0 K)^-1 G0 K at one frequency, linear plant, once the transient has gone.
  FlightSetup setup;
  setup.plant = Plant::linear;
  setup.turn_coordinator = false;
  const Result<Flight> flight = Flight::prepare(fat(), setup);
  constexpr Eigen::Index ticks = 40000;  // 800 s: the slowest closed-loop mode has gone, phugoid included
  constexpr Eigen::Index window = 5000;  // 100 s: 80 periods of 0.8 Hz
  const double hertz = 0.8;
  Eigen::MatrixX3d r = Eigen::MatrixX3d::Zero(ticks, 3);
  for (Eigen::Index t = 0; t < ticks; ++t)
    r(t, 1) = 0.01 * std::cos(2.0 * kPi * hertz * 0.02 * static_cast<double>(t));
  FlightRecord record;
  flight->fly(r, TrialSeed{}, record);
  std::complex<double> sum = 0.0;
  for (Eigen::Index t = ticks - window; t < ticks; ++t) {
    sum += record.output(t, 1) * std::polar(1.0, -2.0 * kPi * hertz * 0.02 * static_cast<double>(t));
  }
  const Eigen::Matrix3cd loop = flight->sampled().response(hertz) * setup.gain.asDiagonal();
  const Eigen::Matrix3cd closed = (Eigen::Matrix3cd::Identity() + loop).inverse() * loop;
  EXPECT_LT(std::abs(2.0 * sum / (0.01 * window) - closed(1, 1)), 1e-6 * std::abs(closed(1, 1)));
}

TEST(Flight, ServosStayInsideTheirLimitsAndTheTimeThereIsCounted) {
  FlightSetup setup;
  setup.closed_loop = false;
  Eigen::MatrixX3d u = Eigen::MatrixX3d::Zero(50, 3);
  u.col(0).head(25).setConstant(0.2);  // a step of 0.14 rad needs 0.13 s at the rate limit
  const FlightRecord record = fly(setup, u);
  EXPECT_GT(record.at_rate_limit[0], 0.1);
  EXPECT_EQ(record.at_rate_limit[1], 0.0);
  EXPECT_EQ(record.at_position_limit[0], 0.0);
  u.col(0).setConstant(1.5);
  EXPECT_GT(fly(setup, u).at_position_limit[0], 0.0);
}

TEST(Actuator, IsLimitedInRateAndPositionAndSettlesOnItsCommand) {
  const Trim trim = trim_level(fat());
  const FlightConstants k(fat());
  State<double> x = trim.state;
  Demand<double> demand = trim.demand;
  demand.surfaces = {0.5, 2.0, -2.0};
  double fastest = 0.0;
  double last = 0.0;
  for (int i = 0; i < 100; ++i) {
    rk4_step(k, demand, Gust<double>{}, 0.02, x);
    fastest = std::max(fastest, std::abs(x[state::surfaces] - last) / 0.02);
    last = x[state::surfaces];
    for (std::size_t s = 0; s < 3; ++s) {
      EXPECT_LE(std::abs(x[state::surface_rates + s]), 1.0472);
      EXPECT_LE(std::abs(x[state::surfaces + s]), 0.6981);
    }
  }
  EXPECT_LE(fastest, 1.0472 * (1.0 + 1e-12));
  EXPECT_NEAR(x[state::surfaces], 0.5, 1e-9);
  EXPECT_EQ(x[state::surfaces + 1], 0.6981);
  EXPECT_EQ(x[state::surfaces + 2], -0.6981);
}

TEST(Flight, TheGyroNoiseOfARecordHasTheVarianceOfItsLastSampleOrOfTheMean) {
  FlightSetup setup;
  setup.imu.noise_rad_sqrt_s = 1e-9;  // too small to move the aircraft
  const double variance = 1e-18 * 200.0;
  constexpr Eigen::Index n = 20000;
  const auto spread = [&](const FlightRecord& r) { return r.output.squaredNorm() / (3.0 * n); };
  const double band = 4.0 * std::sqrt(2.0 / (3.0 * n));
  EXPECT_NEAR(spread(fly(setup, Eigen::MatrixX3d::Zero(n, 3))), variance, band * variance);
  setup.average_imu = true;
  EXPECT_NEAR(spread(fly(setup, Eigen::MatrixX3d::Zero(n, 3))), variance / 4.0, band * variance / 4.0);
}

TEST(Flight, AveragingDelaysByThreeEighthsOfATick) {
  // The mean of samples at 5, 10, 15 and 20 ms of a ramp is its value 7.5 ms before the end.
  FlightSetup last;
  last.closed_loop = false;
  FlightSetup mean = last;
  last.step_s = mean.step_s = 0.005;
  mean.average_imu = true;
  Eigen::MatrixX3d u = Eigen::MatrixX3d::Zero(60, 3);
  for (Eigen::Index t = 0; t < 60; ++t) u(t, 1) = 0.01 * std::sin(0.02 * static_cast<double>(t));
  const FlightRecord a = fly(last, u);
  const FlightRecord b = fly(mean, u);
  const double slope = (a.output(50, 1) - a.output(49, 1)) / 0.02;
  EXPECT_NEAR((a.output(50, 1) - b.output(50, 1)) / slope, 0.0075, 0.0002);
}

TEST(Flight, LeavingTheModelIsAnOutcomeWithItsReasonAndTime) {
  FlightSetup setup;
  setup.closed_loop = false;
  Eigen::MatrixX3d u = Eigen::MatrixX3d::Zero(2000, 3);
  u.col(0).setConstant(0.5);
  const FlightRecord record = fly(setup, u);
  EXPECT_EQ(record.ending, Ending::bank);
  EXPECT_GT(record.samples, 10);
  EXPECT_LT(record.samples, 2000);
  EXPECT_NEAR(record.ending_time_s, 0.02 * static_cast<double>(record.samples), 1e-12);
  EXPECT_TRUE(record.output.allFinite());
  EXPECT_EQ(record.output.bottomRows(2000 - record.samples).cwiseAbs().maxCoeff(), 0.0);
  u.setZero();
  u(3, 1) = std::nan("");
  EXPECT_EQ(fly(setup, u).ending, Ending::not_finite);
}

TEST(Flight, ATurnAtSixtyDegreesOfBankIsFlownWithoutLeavingTheModel) {
  FlightSetup setup;
  setup.gain = Eigen::Vector3d::Constant(0.5);
  Eigen::MatrixX3d r = Eigen::MatrixX3d::Zero(1500, 3);
  r.col(0).head(100).setConstant(1.15);
  r.col(1).tail(1430).setConstant(0.8);  // pulling, as a level turn needs
  const FlightRecord record = fly(setup, r);
  EXPECT_EQ(record.ending, Ending::completed) << name(record.ending) << " at " << record.ending_time_s;
  EXPECT_GT(record.auxiliary.col(0).tail(1400).minCoeff(), 0.9);
  EXPECT_LT(std::abs(record.auxiliary.col(1).tail(1400).maxCoeff()), 0.3);
}

TEST(Flight, AStepThatDoesNotDivideTheTickIsRefused) {
  FlightSetup setup;
  setup.step_s = 0.015;
  const Result<Flight> flight = Flight::prepare(fat(), setup);
  ASSERT_FALSE(flight);
  EXPECT_EQ(flight.error().key, "step_s");
}

}  // namespace
}  // namespace fatmc
