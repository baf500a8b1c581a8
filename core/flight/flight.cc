#include "core/flight/flight.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/text.h"
#include "core/flight/flight_loop.h"
#include "core/flight/step_parts.h"

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

constexpr int kMostParts =
    100;  // of a Runge-Kutta step: a tick that takes a hundred times as long is a mistake

/// Into how many parts the setup's step is split, so that every stage of the flight is flown stably.
int parts_of_steps(const Aircraft& aircraft, const FlightSetup& setup, const Trim& trim) {
  int most = parts_of_step(aircraft, linearize(aircraft, trim), setup.step_s);
  for (const FlightStage& stage : setup.stages) {
    most = std::max(most, parts_of_step(stage.aircraft, linearize(stage.aircraft, trim), setup.step_s));
  }
  return most;
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
      steps_per_tick_(parts(tick_s_, setup.step_s) * parts_of_steps(aircraft, setup, trim_)),
      imu_samples_(parts(tick_s_, setup.imu_step_s)),
      direct_path_(setup.path == SignalPath{} && setup.stages.empty()),
      rigid_(aircraft.additional == AdditionalPhysics{}),
      continuous_(linearize(aircraft, trim_)),
      sampled_(sample(aircraft, trim_, tick_s_, steps_per_tick_)),
      dryden_(setup.turbulence_m_s, aircraft.speed_m_s, aircraft.span_m, tick_s_) {
  const double step_s =
      steps_per_tick_ == parts(tick_s_, setup.step_s) ? setup.step_s : tick_s_ / steps_per_tick_;
  const auto add = [&](const FlightStage& stage) {
    const FlightConstants constants(stage.aircraft);
    stages_.push_back({stage.from_s, constants, AdditionalDynamics(stage.aircraft, constants, true),
                       Gyro(stage.imu, imu_samples_ / tick_s_), stage.gain, stage.path,
                       PreparedStage::Delay(stage.path.command_delay_s, tick_s_, step_s)});
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
  if (const int split = parts_of_steps(aircraft, setup, trim); split > kMostParts) {
    return wrong("step_s", "the aircraft's fastest mode needs steps of " +
                               significant(setup.step_s / split, 2) +
                               " s, write a slower one or a shorter step");
  }
  return Flight(aircraft, setup, trim);
}

// Instantiated in flight_modified.cc: a unit of their own, so that the plain flight is inlined as if they did not exist.
extern template void Flight::fly_plant(internal::LinearPlant, internal::ModifiedPath,
                                       const Eigen::Ref<const Eigen::MatrixX3d>&, const TrialSeed&,
                                       FlightRecord&) const;
extern template void Flight::fly_plant(internal::NonlinearPlant<RigidDynamics>, internal::ModifiedPath,
                                       const Eigen::Ref<const Eigen::MatrixX3d>&, const TrialSeed&,
                                       FlightRecord&) const;
extern template void Flight::fly_plant(internal::NonlinearPlant<AdditionalDynamics>, internal::ModifiedPath,
                                       const Eigen::Ref<const Eigen::MatrixX3d>&, const TrialSeed&,
                                       FlightRecord&) const;
extern template void Flight::fly_plant(internal::NonlinearPlant<AdditionalDynamics>, internal::DirectPath,
                                       const Eigen::Ref<const Eigen::MatrixX3d>&, const TrialSeed&,
                                       FlightRecord&) const;

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
