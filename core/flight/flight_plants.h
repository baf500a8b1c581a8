// Internal to core/flight: what moves during a tick.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include "core/flight/additional_dynamics.h"
#include "core/flight/flight.h"

namespace fatmc::internal {

/// What controller, sensors and limits want to know about the plant at a tick.
struct Observation {
  std::array<double, 3> rates;     ///< at the gyros
  std::array<double, 3> velocity;  ///< over ground
  double phi, theta;
  double level_turn;  ///< sin(phi) cos(theta)
};

/// Counts of limited servos.
struct LimitCount {
  std::array<std::int64_t, 3> position{}, rate{};
  std::int64_t looks = 0;
  void look(const FlightConstants& k, const double* positions, const double* rates) {
    ++looks;
    for (std::size_t i = 0; i < 3; ++i) {
      position[i] += std::abs(positions[i]) >= k.position_limit[i];
      rate[i] += std::abs(rates[i]) >= k.rate_limit[i];
    }
  }
};

/// A part of a tick over which the servos see the same commands.
struct CommandSegment {
  std::array<double, 3> command;
  int steps;  ///< Runge-Kutta steps
  double step_s;
};

/// The full equations of motion; Dynamics: RigidDynamics or AdditionalDynamics.
template <typename Dynamics>
class NonlinearPlant {
 public:
  NonlinearPlant(const FlightConstants& constants, const Trim& trim, const Dynamics& dynamics)
      : constants_(&constants), demand_(trim.demand), dynamics_(dynamics) {
    x_.fill(0.0);
    for (std::size_t i = 0; i < state::size; ++i) x_[i] = trim.state[i];
    dynamics_.start(trim.demand.surfaces);
  }

  [[nodiscard]] Observation observe() const {
    const std::array<double, 3> down = down_in_body(x_);
    return {rates(),
            {x_[state::velocity], x_[state::velocity + 1], x_[state::velocity + 2]},
            std::atan2(down[1], down[2]),
            std::asin(std::clamp(-down[0], -1.0, 1.0)),
            down[1]};
  }

  /// Flies a segment; `node(step_s, rates)` is told the rates after each Runge-Kutta step.
  template <typename Node>
  void advance(const CommandSegment& segment, int /*part*/, const Gust<double>& gust, LimitCount& count,
               Node node) {
    Demand<double> demand;
    demand.surfaces = mix(*constants_, segment.command, demand_.surfaces);
    demand.throttle = demand_.throttle;
    for (int i = 0; i < segment.steps; ++i) {
      rk4_step(*constants_, demand, gust, segment.step_s, x_, dynamics_);
      dynamics_.settle(x_);
      count.look(*constants_, &x_[state::surfaces], &x_[state::surface_rates]);
      node(segment.step_s, rates());
    }
  }

  /// The aircraft has changed: motion and trim settings stay as they are.
  void change(const FlightConstants& constants, const AdditionalDynamics& dynamics) {
    constants_ = &constants;
    if constexpr (Dynamics::states == state::extended_size) {
      const Dynamics before = dynamics_;
      dynamics_ = dynamics;
      dynamics_.continue_from(before);
    }
  }

 private:
  [[nodiscard]] std::array<double, 3> rates() const {
    std::array<double, 3> out = {x_[state::rates], x_[state::rates + 1], x_[state::rates + 2]};
    if constexpr (Dynamics::states == state::extended_size) {
      for (std::size_t i = 0; i < 3; ++i) out[i] += x_[state::flexible_rate + i];
    }
    return out;
  }

  const FlightConstants* constants_;
  Demand<double> demand_;
  Dynamics dynamics_;
  std::array<double, Dynamics::states> x_;
};

/// The sampled linear step map, in deviations from trim; one map a segment.
class LinearPlant {
 public:
  LinearPlant(const FlightConstants& constants, const Trim& trim, const std::vector<LinearModel>& maps)
      : constants_(constants), trim_(trim), maps_(maps) {
    x_.setZero();
  }

  [[nodiscard]] Observation observe() const {
    const double theta = trim_.alpha_rad + x_[7];
    const State<double>& trim = trim_.state;
    return {
        {x_[3], x_[4], x_[5]},
        {trim[state::velocity] + x_[0], trim[state::velocity + 1] + x_[1], trim[state::velocity + 2] + x_[2]},
        x_[6],
        theta,
        std::sin(x_[6]) * std::cos(theta)};
  }

  template <typename Node>
  void advance(const CommandSegment& segment, int part, const Gust<double>& gust, LimitCount& count,
               Node node) {
    const LinearModel& map = maps_[static_cast<std::size_t>(part)];
    Eigen::Matrix<double, 6, 1> g;
    g << gust.velocity[0], gust.velocity[1], gust.velocity[2], gust.rates[0], gust.rates[1], gust.rates[2];
    const Eigen::Matrix<double, kLinearStates, 1> next =
        map.a * x_ + map.b * Eigen::Map<const Eigen::Vector3d>(segment.command.data()) + map.e * g;
    x_ = next;
    std::array<double, 3> position;
    for (std::size_t i = 0; i < 3; ++i) position[i] = trim_.demand.surfaces[i] + x_[10 + i];
    count.look(constants_, position.data(), x_.data() + 13);
    node(segment.steps * segment.step_s, std::array<double, 3>{x_[3], x_[4], x_[5]});
  }

  void change(const FlightConstants&, const AdditionalDynamics&) {}

 private:
  const FlightConstants& constants_;
  const Trim& trim_;
  const std::vector<LinearModel>& maps_;
  Eigen::Matrix<double, kLinearStates, 1> x_;
};

}  // namespace fatmc::internal
