// Internal to core/flight: the loop over the ticks of a flight, for any plant and signal path.
#pragma once

#include <cmath>
#include <vector>

#include "core/flight/flight.h"
#include "core/flight/flight_paths.h"
#include "core/flight/flight_plants.h"

namespace fatmc {
namespace internal {

/// Limits of the flow angles as what velocities compare with.
struct AngleLimits {
  explicit AngleLimits(const Validity& v)
      : tan_alpha_min(std::tan(v.alpha_min_rad)),
        tan_alpha_max(std::tan(v.alpha_max_rad)),
        sin_beta_max(std::sin(v.beta_max_rad)) {}
  double tan_alpha_min, tan_alpha_max, sin_beta_max;
};

/// Where the model stops being valid. Comparisons are written so that a NaN fails them.
inline Ending judge(const Validity& limits, const AngleLimits& angles, const Observation& at,
                    const Gust<double>& gust, double airspeed) {
  if (!std::isfinite(airspeed + at.rates[0] + at.rates[1] + at.rates[2] + at.phi + at.theta)) {
    return Ending::not_finite;
  }
  if (!(airspeed >= limits.speed_min_m_s && airspeed <= limits.speed_max_m_s)) return Ending::airspeed;
  const double u = at.velocity[0] - gust.velocity[0];
  const double v = at.velocity[1] - gust.velocity[1];
  const double w = at.velocity[2] - gust.velocity[2];
  // alpha between -pi/2 and pi/2 compares as its tangent; flying backwards is beyond any limit.
  if (!(u > 0.0 && w >= u * angles.tan_alpha_min && w <= u * angles.tan_alpha_max)) {
    return Ending::angle_of_attack;
  }
  if (!(std::abs(v) <= airspeed * angles.sin_beta_max)) return Ending::side_slip;
  if (!(std::abs(at.phi) <= limits.bank_max_rad)) return Ending::bank;
  if (!(std::abs(at.theta) <= limits.pitch_max_rad)) return Ending::pitch;
  return Ending::completed;
}

}  // namespace internal

template <typename PlantType, typename Path>
void Flight::fly_plant(PlantType plant, Path path, const Eigen::Ref<const Eigen::MatrixX3d>& reference,
                       const TrialSeed& trial, FlightRecord& record) const {
  RandomStream gust_noise(trial, "turbulence");
  RandomStream imu_noise(trial, "imu");
  const bool windy = setup_.turbulence_m_s > 0.0;
  Dryden::StateVector air{};
  if (windy && !setup_.gusts_from_calm) air = dryden_.start(gust_noise);
  const internal::AngleLimits angles(aircraft_.validity);
  internal::LimitCount count;
  std::array<double, 3> square_sum{};
  // Rates at the nodes of the last tick, its begin included; only an averaging unit reads them.
  const int nodes = setup_.plant == FlightSetup::Plant::linear ? 1 : steps_per_tick_;
  std::vector<std::array<double, 3>> node_rates(static_cast<std::size_t>(nodes) + 1, plant.observe().rates);

  const Eigen::Index n = reference.rows();
  for (Eigen::Index t = 0; t < n; ++t) {
    if constexpr (Path::kModified) {
      if (path.begin(t)) plant.change(path.stage().constants, path.stage().additional);
    }
    Gust<double> gust;
    if (windy) {
      const Dryden::Gusts g = dryden_.gusts(air);
      const double side = setup_.gusts == FlightSetup::Gusts::all ? 1.0 : 0.0;
      gust = {{g[0], side * g[1], g[2]}, {side * g[3], g[4], side * g[5]}};
      dryden_.advance(air, gust_noise);
    }
    const internal::Observation at = plant.observe();
    double air2 = 0.0;
    for (std::size_t i = 0; i < 3; ++i)
      air2 += (at.velocity[i] - gust.velocity[i]) * (at.velocity[i] - gust.velocity[i]);
    const double airspeed = std::sqrt(air2);
    record.ending = internal::judge(aircraft_.validity, angles, at, gust, airspeed);
    if (record.ending != Ending::completed) {
      record.ending_time_s = static_cast<double>(t) * tick_s_;
      break;
    }

    std::array<double, 3> y{};
    if (!setup_.average_imu) {
      y = path.gyro().sample(path.sensed(at.rates), imu_noise);
    } else {
      for (int s = 1; s <= imu_samples_; ++s) {
        const double place = static_cast<double>(s) * nodes / imu_samples_;
        const auto before = std::min(static_cast<std::size_t>(place), static_cast<std::size_t>(nodes) - 1);
        const double share = place - static_cast<double>(before);
        std::array<double, 3> rates;
        for (std::size_t i = 0; i < 3; ++i) {
          rates[i] = (1.0 - share) * node_rates[before][i] + share * node_rates[before + 1][i];
        }
        const std::array<double, 3> one = path.gyro().sample(path.disturbed(rates), imu_noise);
        for (std::size_t i = 0; i < 3; ++i) y[i] += one[i] / imu_samples_;
      }
      node_rates[0] = path.lagged(at.rates);
    }

    std::array<double, 3> command;
    for (int i = 0; i < 3; ++i) {
      const double r = reference(t, i);
      command[static_cast<std::size_t>(i)] =
          setup_.closed_loop ? path.gain(i) * (r - y[static_cast<std::size_t>(i)]) : r;
    }
    if (setup_.closed_loop && setup_.turn_coordinator) {
      const double ground_speed =
          std::sqrt(at.velocity[0] * at.velocity[0] + at.velocity[1] * at.velocity[1] +
                    at.velocity[2] * at.velocity[2]);
      command[2] += path.turn_coordinator() * (path.gain(2) * kGravity / ground_speed * at.level_turn);
    }
    for (int i = 0; i < 3; ++i) {
      const double u = path.recorded(static_cast<std::size_t>(i), command[static_cast<std::size_t>(i)]);
      record.input(t, i) = u;
      record.output(t, i) = y[static_cast<std::size_t>(i)];
      square_sum[static_cast<std::size_t>(i)] += u * u;
    }
    record.auxiliary(t, 0) = at.phi;
    record.auxiliary(t, 1) = at.theta;
    record.auxiliary(t, 2) = path.airspeed(airspeed);
    record.samples = t + 1;

    std::size_t next_node = 1;
    path.segments(command, [&](const internal::CommandSegment& segment, int part) {
      plant.advance(segment, part, gust, count, [&](double step_s, const std::array<double, 3>& rates) {
        const std::array<double, 3>& seen = path.node(step_s, rates);
        if (setup_.average_imu) node_rates[next_node++] = seen;
      });
    });
  }
  if (record.ending == Ending::completed) record.ending_time_s = static_cast<double>(n) * tick_s_;
  for (int i = 0; i < 3 && record.samples > 0; ++i) {
    const auto c = static_cast<std::size_t>(i);
    record.at_position_limit[i] = static_cast<double>(count.position[c]) / static_cast<double>(count.looks);
    record.at_rate_limit[i] = static_cast<double>(count.rate[c]) / static_cast<double>(count.looks);
    record.input_rms[i] = std::sqrt(square_sum[c] / static_cast<double>(record.samples));
  }
}

}  // namespace fatmc
