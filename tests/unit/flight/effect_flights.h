// Flights of the FAT with effects, for tests of their physics.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <complex>

#include "core/flight/effects/effect.h"
#include "tests/unit/flight/fat.h"

namespace fatmc {

using Complex = std::complex<double>;
using Plant = FlightSetup::Plant;

inline constexpr double kDegree = kPi / 180.0;

inline ModifiedFlight with(std::initializer_list<std::string_view> texts, const FlightSetup& setup) {
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

inline FlightRecord fly(const ModifiedFlight& modified, const Eigen::MatrixX3d& r) {
  const Result<Flight> flight = Flight::prepare(modified.aircraft, modified.setup);
  EXPECT_TRUE(flight.has_value()) << flight.error().text();
  FlightRecord record;
  flight->fly(r, TrialSeed{1, 2, 3, 4}, record);
  return record;
}

inline FlightSetup open_loop() {
  FlightSetup setup;
  setup.closed_loop = false;
  return setup;
}

inline Eigen::MatrixX3d waves(Eigen::Index ticks, double amplitude) {
  Eigen::MatrixX3d r(ticks, 3);
  for (Eigen::Index t = 0; t < ticks; ++t) {
    const double s = 0.02 * static_cast<double>(t);
    r.row(t) << amplitude * std::sin(3.0 * s), amplitude * std::sin(4.0 * s), amplitude * std::sin(5.0 * s);
  }
  return r;
}

inline Eigen::MatrixX3d later(const Eigen::MatrixX3d& r, Eigen::Index ticks) {
  Eigen::MatrixX3d out = Eigen::MatrixX3d::Zero(r.rows(), 3);
  out.bottomRows(r.rows() - ticks) = r.topRows(r.rows() - ticks);
  return out;
}

/// Amplitude of exp(j 2 pi f t) in x over a whole number of periods from tick `from` on.
inline Complex component(const Eigen::VectorXd& x, double frequency_hz, Eigen::Index from) {
  Complex sum = 0.0;
  for (Eigen::Index t = from; t < x.size(); ++t) {
    sum += x[t] * std::polar(1.0, -2.0 * kPi * frequency_hz * 0.02 * static_cast<double>(t));
  }
  return 2.0 * sum / static_cast<double>(x.size() - from);
}

inline Eigen::MatrixX3d sine(int axis, double frequency_hz, double amplitude, Eigen::Index ticks) {
  Eigen::MatrixX3d r = Eigen::MatrixX3d::Zero(ticks, 3);
  for (Eigen::Index t = 0; t < ticks; ++t) {
    r(t, axis) = amplitude * std::sin(2.0 * kPi * frequency_hz * 0.02 * static_cast<double>(t));
  }
  return r;
}

inline LinearModel linear(const ModifiedFlight& modified) {
  return linearize(modified.aircraft, trim_level(modified.aircraft));
}

}  // namespace fatmc
