// Internal to core/flight: what lies between plant, gyros, controller, servos and record, chosen once a
// flight.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/flight/flight_plants.h"
#include "core/flight/flight_stages.h"

namespace fatmc::internal {

/// Signals pass at once and unchanged, and nothing changes in flight.
class DirectPath {
 public:
  static constexpr bool kModified = false;
  DirectPath(const PreparedStage& stage, int steps, double step_s)
      : gyro_(stage.gyro), gain_(stage.gain), steps_(steps), step_s_(step_s) {}

  [[nodiscard]] const Gyro& gyro() const { return gyro_; }
  [[nodiscard]] double gain(int axis) const { return gain_[axis]; }
  [[nodiscard]] static double turn_coordinator() { return 1.0; }
  [[nodiscard]] static double recorded(std::size_t /*axis*/, double command) { return command; }
  [[nodiscard]] static double airspeed(double airspeed) { return airspeed; }
  /// Rates of the body as the gyro's errors find them: behind lags, with disturbances.
  [[nodiscard]] static const std::array<double, 3>& sensed(const std::array<double, 3>& rates) {
    return rates;
  }
  [[nodiscard]] static const std::array<double, 3>& lagged(const std::array<double, 3>& rates) {
    return rates;
  }
  [[nodiscard]] static const std::array<double, 3>& disturbed(const std::array<double, 3>& rates) {
    return rates;
  }
  /// Told the rates after a Runge-Kutta step; returns them behind lags.
  static const std::array<double, 3>& node(double /*step_s*/, const std::array<double, 3>& rates) {
    return rates;
  }
  /// Calls fly(segment, part) for the parts of the tick.
  template <typename Fly>
  void segments(const std::array<double, 3>& command, Fly fly) const {
    fly(CommandSegment{command, steps_, step_s_}, 0);
  }

 private:
  const Gyro& gyro_;
  const Eigen::Vector3d gain_;
  const int steps_;
  const double step_s_;
};

/// Delay, dead zone, gyro lag, tones, offsets, and stages that follow each other.
class ModifiedPath {
 public:
  static constexpr bool kModified = true;
  ModifiedPath(const std::vector<PreparedStage>& stages, double tick_s, const std::array<double, 3>& rates)
      : stages_(stages), stage_(&stages.front()), tick_s_(tick_s), before_(rates), lagged_(rates) {
    int longest = 0;
    for (const PreparedStage& stage : stages) longest = std::max(longest, stage.delay.ticks);
    past_.resize(static_cast<std::size_t>(longest) + 2, std::array<double, 3>{});
  }

  /// Goes to tick t; true when a new stage begins.
  bool begin(Eigen::Index t) {
    time_s_ = static_cast<double>(t) * tick_s_;
    const PreparedStage* const was = stage_;
    while (stage_ != &stages_.back() && (stage_ + 1)->from_s <= time_s_ + 1e-9) ++stage_;
    return stage_ != was;
  }
  [[nodiscard]] const PreparedStage& stage() const { return *stage_; }

  [[nodiscard]] const Gyro& gyro() const { return stage_->gyro; }
  [[nodiscard]] double gain(int axis) const { return stage_->gain[axis]; }
  [[nodiscard]] double turn_coordinator() const { return stage_->path.turn_coordinator; }
  [[nodiscard]] double recorded(std::size_t axis, double command) const {
    return command + stage_->path.command_offset[axis];
  }
  [[nodiscard]] double airspeed(double airspeed) const { return airspeed * stage_->path.airspeed_reading; }

  [[nodiscard]] std::array<double, 3> sensed(const std::array<double, 3>& rates) const {
    return disturbed(lagged(rates));
  }
  [[nodiscard]] const std::array<double, 3>& lagged(const std::array<double, 3>& rates) const {
    return stage_->path.gyro_time_constant_s > 0.0 ? lagged_ : rates;
  }
  [[nodiscard]] std::array<double, 3> disturbed(std::array<double, 3> rates) const {
    for (std::size_t i = 0; i < 3; ++i) {
      const Tone& tone = stage_->path.tones[i];
      if (tone.amplitude_rad_s != 0.0) {
        rates[i] += tone.amplitude_rad_s * std::sin(2.0 * kPi * tone.frequency_hz * time_s_ + tone.phase_rad);
      }
    }
    return rates;
  }

  /// Lag over a step, exact for rates w that are linear over it: with a = exp(-h/T),
  ///   y1 = a y0 + w1 - a w0 - (T/h)(1 - a)(w1 - w0).
  const std::array<double, 3>& node(double step_s, const std::array<double, 3>& rates) {
    const double constant = stage_->path.gyro_time_constant_s;
    if (constant > 0.0) {
      const double a = std::exp(-step_s / constant);
      const double ramp = constant / step_s * (1.0 - a);
      for (std::size_t i = 0; i < 3; ++i) {
        lagged_[i] = a * lagged_[i] + rates[i] - a * before_[i] - ramp * (rates[i] - before_[i]);
      }
    } else {
      lagged_ = rates;
    }
    before_ = rates;
    return lagged_;
  }

  /// With a delay of m ticks and a fraction: the command of m + 1 ticks ago until the fraction is over, then
  /// that of m ticks ago. Before the flight commands were zero.
  template <typename Fly>
  void segments(const std::array<double, 3>& command, Fly fly) {
    std::rotate(past_.begin(), past_.end() - 1, past_.end());
    for (std::size_t i = 0; i < 3; ++i) past_[0][i] = outside(command[i], stage_->path.dead_zone[i]);
    const PreparedStage::Delay& delay = stage_->delay;
    const auto ticks = static_cast<std::size_t>(delay.ticks);
    int part = 0;
    if (delay.steps_before > 0) {
      fly(CommandSegment{past_[ticks + 1], delay.steps_before, delay.step_before_s}, part++);
    }
    fly(CommandSegment{past_[ticks], delay.steps_after, delay.step_after_s}, part);
  }

 private:
  static double outside(double value, double half_width) {
    if (half_width == 0.0) return value;
    return value > half_width ? value - half_width : value < -half_width ? value + half_width : 0.0;
  }

  const std::vector<PreparedStage>& stages_;
  const PreparedStage* stage_;
  const double tick_s_;
  double time_s_ = 0.0;
  std::array<double, 3> before_, lagged_;
  std::vector<std::array<double, 3>> past_;  ///< commands, latest first
};

}  // namespace fatmc::internal
