#include "core/flight/flight.h"

#include <cmath>
#include <vector>

#include "core/base/text.h"
#include "core/flight/flight_paths.h"
#include "core/flight/flight_plants.h"

namespace fatmc {
namespace {

/// How many parts a tick has; 0 when `part` does not divide it.
int parts(double tick_s, double part_s) {
  const double ratio = tick_s / part_s;
  const double whole = std::round(ratio);
  const bool divides =
      std::isfinite(ratio) && whole >= 1.0 && whole <= 1000.0 && std::abs(ratio - whole) < 1e-9 * whole;
  return divides ? static_cast<int>(whole) : 0;
}

/// Limits of the flow angles as what velocities compare with.
struct AngleLimits {
  explicit AngleLimits(const Validity& v)
      : tan_alpha_min(std::tan(v.alpha_min_rad)),
        tan_alpha_max(std::tan(v.alpha_max_rad)),
        sin_beta_max(std::sin(v.beta_max_rad)) {}
  double tan_alpha_min, tan_alpha_max, sin_beta_max;
};

/// Where the model stops being valid. Comparisons are written so that a NaN fails them.
Ending judge(const Validity& limits, const AngleLimits& angles, const internal::Observation& at,
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

}  // namespace

std::string_view name(Ending ending) {
  switch (ending) {
    case Ending::completed:
      return "completed";
    case Ending::not_finite:
      return "not finite";
    case Ending::angle_of_attack:
      return "angle of attack";
    case Ending::side_slip:
      return "side-slip";
    case Ending::bank:
      return "bank";
    case Ending::pitch:
      return "pitch";
    case Ending::airspeed:
      return "airspeed";
  }
  return "?";
}

Flight::Flight(const Aircraft& aircraft, const FlightSetup& setup, Trim trim)
    : aircraft_(aircraft),
      setup_(setup),
      trim_(std::move(trim)),
      tick_s_(1.0 / setup.rate_hz),
      steps_per_tick_(parts(tick_s_, setup.step_s)),
      imu_samples_(parts(tick_s_, setup.imu_step_s)),
      direct_path_(setup.path == SignalPath{} && setup.stages.empty()),
      rigid_(aircraft.additional == AdditionalPhysics{}),
      continuous_(linearize(aircraft, trim_)),
      sampled_(sample(aircraft, trim_, tick_s_, steps_per_tick_)),
      dryden_(setup.turbulence_m_s, aircraft.speed_m_s, aircraft.span_m, tick_s_) {
  const auto add = [&](const FlightStage& stage) {
    const FlightConstants constants(stage.aircraft);
    stages_.push_back({stage.from_s, constants, AdditionalDynamics(stage.aircraft, constants, true),
                       Gyro(stage.imu, imu_samples_ / tick_s_), stage.gain, stage.path,
                       PreparedStage::Delay(stage.path.command_delay_s, tick_s_, setup.step_s)});
  };
  add({0.0, aircraft, setup.imu, setup.gain, setup.path});
  for (const FlightStage& stage : setup.stages) {
    add(stage);
    rigid_ = rigid_ && stage.aircraft.additional == AdditionalPhysics{};
  }
  const PreparedStage::Delay& delay = stages_.front().delay;
  if (delay.steps_before == 0) {
    segment_maps_ = {sampled_};
  } else {
    segment_maps_ = {sample(aircraft, trim_, delay.steps_before * delay.step_before_s, delay.steps_before),
                     sample(aircraft, trim_, delay.steps_after * delay.step_after_s, delay.steps_after)};
  }
}

namespace {

/// What the signal path and later stages may not be.
Status check_path(const Aircraft& aircraft, const FlightSetup& setup) {
  const auto wrong = [](std::string key, std::string message) -> Status {
    return fail(Error{"", 0, std::move(key), std::move(message)});
  };
  std::vector<const SignalPath*> paths = {&setup.path};
  double time_s = 0.0;
  for (const FlightStage& stage : setup.stages) {
    if (!(stage.from_s > time_s)) return wrong("stages", "must begin after the start, one after the other");
    time_s = stage.from_s;
    if (Status status = check(stage.aircraft); !status) return status;
    paths.push_back(&stage.path);
  }
  for (const SignalPath* path : paths) {
    if (!(path->command_delay_s >= 0.0 && path->command_delay_s <= 10.0)) {
      return wrong("command_delay_s", "write a delay from 0 to 10 s");
    }
    const PreparedStage::Delay delay(path->command_delay_s, 1.0 / setup.rate_hz, setup.step_s);
    if (setup.average_imu && delay.steps_before > 0) {
      return wrong("command_delay_s",
                   "averaged gyros need equal Runge-Kutta steps: write a whole number of ticks");
    }
    if (!(path->gyro_time_constant_s >= 0.0)) return wrong("gyro_time_constant_s", "write at least 0");
  }
  if (setup.plant == FlightSetup::Plant::linear) {
    if (!setup.stages.empty()) return wrong("plant", "changes in flight need plant = \"nonlinear\"");
    if (aircraft.additional.has_modes()) {
      return wrong("plant", "flexible modes and slosh need plant = \"nonlinear\"");
    }
  }
  return {};
}

}  // namespace

Result<Flight> Flight::prepare(const Aircraft& aircraft, const FlightSetup& setup) {
  const auto wrong = [](std::string key, std::string message) {
    return fail(Error{"", 0, std::move(key), std::move(message)});
  };
  if (const Status status = check(aircraft); !status) return fail(status.error());
  if (!(setup.rate_hz > 0.0)) return wrong("rate_hz", "write a rate above zero");
  const double tick_s = 1.0 / setup.rate_hz;
  if (parts(tick_s, setup.step_s) == 0) {
    return wrong("step_s",
                 shortest(setup.step_s) + " does not divide the tick of " + shortest(tick_s) + " s");
  }
  if (parts(tick_s, setup.imu_step_s) == 0) {
    return wrong("imu_step_s",
                 shortest(setup.imu_step_s) + " does not divide the tick of " + shortest(tick_s) + " s");
  }
  if (!(setup.turbulence_m_s >= 0.0))
    return wrong("turbulence_m_s", "write a standard deviation of at least 0");
  if (const Status status = check_path(aircraft, setup); !status) return fail(status.error());
  const Trim trim = trim_level(aircraft);
  if (!trim.usable()) {
    return wrong("speed_m_s",
                 "no level flight at " + shortest(aircraft.speed_m_s) + " m/s: " +
                     (trim.outcome == Trim::Outcome::outside_model
                          ? std::string("it needs more than throttle, elevator or angle of attack allow")
                          : "the trim solver stopped after " + std::to_string(trim.iterations) +
                                " iterations with a residual of " + significant(trim.residual, 3)));
  }
  return Flight(aircraft, setup, trim);
}

template <typename PlantType, typename Path>
void Flight::fly_plant(PlantType plant, Path path, const Eigen::Ref<const Eigen::MatrixX3d>& reference,
                       const TrialSeed& trial, FlightRecord& record) const {
  RandomStream gust_noise(trial, "turbulence");
  RandomStream imu_noise(trial, "imu");
  const bool windy = setup_.turbulence_m_s > 0.0;
  Dryden::StateVector air{};
  if (windy && !setup_.gusts_from_calm) air = dryden_.start(gust_noise);
  const AngleLimits angles(aircraft_.validity);
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
    record.ending = judge(aircraft_.validity, angles, at, gust, airspeed);
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

void Flight::fly(const Eigen::Ref<const Eigen::MatrixX3d>& reference, const TrialSeed& trial,
                 FlightRecord& record) const {
  const Eigen::Index n = reference.rows();
  record.reference = reference;
  record.input.setZero(n, 3);
  record.output.setZero(n, 3);
  record.auxiliary.setZero(n, 3);
  record.ending = Ending::completed;
  record.samples = 0;
  record.ending_time_s = 0.0;
  record.at_position_limit.setZero();
  record.at_rate_limit.setZero();
  record.input_rms.setZero();
  // One loop a kind of flight: a flight without effects pays for none of them.
  const auto fly_with = [&](auto plant) {
    if (direct_path_) {
      const internal::DirectPath path(stages_.front(), steps_per_tick_, tick_s_ / steps_per_tick_);
      fly_plant(plant, path, reference, trial, record);
    } else {
      const internal::ModifiedPath path(stages_, tick_s_, plant.observe().rates);
      fly_plant(plant, path, reference, trial, record);
    }
  };
  const PreparedStage& first = stages_.front();
  if (setup_.plant == FlightSetup::Plant::linear) {
    fly_with(internal::LinearPlant(first.constants, trim_, segment_maps_));
  } else if (rigid_) {
    fly_with(internal::NonlinearPlant<RigidDynamics>(first.constants, trim_, RigidDynamics{}));
  } else {
    fly_with(internal::NonlinearPlant<AdditionalDynamics>(first.constants, trim_, first.additional));
  }
}

}  // namespace fatmc
