// What lies between controller, servos, gyros and record. The default is nothing: signals pass at once and
// unchanged.
#pragma once

#include <array>

namespace fatmc {

/// A sinusoidal disturbance of one gyro: amplitude sin(2 pi f t + phase).
struct Tone {
  double amplitude_rad_s = 0.0;
  double frequency_hz = 0.0;
  double phase_rad = 0.0;
  bool operator==(const Tone&) const = default;
};

struct SignalPath {
  /// Between the controller's command and the servos; need not be a whole number of ticks.
  double command_delay_s = 0.0;
  /// Half width d on the normalised commands: |u| <= d gives 0, beyond u -+ d. Counted from trim.
  std::array<double, 3> dead_zone{};
  /// T of 1/(T s + 1) between the body's rates and the gyros, the rates being linear between nodes.
  double gyro_time_constant_s = 0.0;
  std::array<Tone, 3> tones;
  double turn_coordinator = 1.0;  ///< factor on its rate command
  /// What the record's input has on top of the feedback: commands are counted from the trim of a model that
  /// is not quite what flies.
  std::array<double, 3> command_offset{};
  double airspeed_reading = 1.0;  ///< recorded over true airspeed
  bool operator==(const SignalPath&) const = default;
};

}  // namespace fatmc
