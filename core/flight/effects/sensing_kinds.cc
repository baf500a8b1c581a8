#include <algorithm>
#include <array>
#include <cmath>

#include "core/flight/effects/kinds.h"

namespace fatmc::effects {
namespace {

void write_lag(const EffectArguments& with, const Trim&, Aircraft&, FlightSetup& setup) {
  setup.path.gyro_time_constant_s += with["time_constant_s"];
}

void write_noise(const EffectArguments& with, const Trim&, Aircraft&, FlightSetup& setup) {
  setup.imu.noise_rad_sqrt_s *= with["factor"];
}

void write_bias(const EffectArguments& with, const Trim&, Aircraft&, FlightSetup& setup) {
  setup.imu.bias_rad_s[with.axis()] += with["bias_deg_s"] * kDegree;
}

void write_scale(const EffectArguments& with, const Trim&, Aircraft&, FlightSetup& setup) {
  setup.imu.scale_error[with.axis()] += with["error"];
}

/// Unit turned about an axis: w is seen as R w with R = I cos + ..., then come the unit's own errors.
void write_misalignment(const EffectArguments& with, const Trim&, Aircraft&, FlightSetup& setup) {
  const double angle = with["angle_deg"] * kDegree;
  if (angle == 0.0) return;
  Imu& imu = setup.imu;
  const auto& m = imu.misalignment_rad;
  Eigen::Matrix3d own;
  own << 1.0 + imu.scale_error[0], m[0], m[1], m[2], 1.0 + imu.scale_error[1], m[3], m[4], m[5],
      1.0 + imu.scale_error[2];
  const auto axis = static_cast<Eigen::Index>(with.axis());
  const Eigen::Index j = (axis + 1) % 3;
  const Eigen::Index k = (axis + 2) % 3;
  Eigen::Matrix3d turned = Eigen::Matrix3d::Identity();
  turned(j, j) = turned(k, k) = std::cos(angle);
  turned(j, k) = std::sin(angle);
  turned(k, j) = -std::sin(angle);
  const Eigen::Matrix3d both = own * turned;
  imu.scale_error = {both(0, 0) - 1.0, both(1, 1) - 1.0, both(2, 2) - 1.0};
  imu.misalignment_rad = {both(0, 1), both(0, 2), both(1, 0), both(1, 2), both(2, 0), both(2, 1)};
}

void write_quantisation(const EffectArguments& with, const Trim&, Aircraft&, FlightSetup& setup) {
  setup.imu.coarse_step_rad_s = std::max(setup.imu.coarse_step_rad_s, with["step_deg_s"] * kDegree);
}

void write_tone(const EffectArguments& with, const Trim&, Aircraft&, FlightSetup& setup) {
  if (with["amplitude_deg_s"] == 0.0) return;
  setup.path.tones[with.axis()] = {with["amplitude_deg_s"] * kDegree, with["frequency_hz"],
                                   with["phase_deg"] * kDegree};
}

void write_turbulence(const EffectArguments& with, const Trim&, Aircraft&, FlightSetup& setup) {
  setup.turbulence_m_s *= with["factor"];
}

}  // namespace

std::vector<EffectKind> sensing_kinds() {
  EffectParameter noise = factor("noise over the unit's", 3.0, 10.0, 0.01, 1e3);
  noise.mirror = EffectParameter::Mirror::none;
  return {
      {.id = "gyro_lag",
       .title = "lag of the gyros",
       .physics = "A first-order lag 1/(T s + 1) between the body's rates and the gyros.",
       .parameters = {size("time_constant_s", "s", "T", 0.01, 0.05, 5.0)},
       .once = true,
       .write = write_lag},
      {.id = "gyro_noise",
       .title = "noise of the gyros",
       .physics = "The angle random walk is larger or smaller by the factor: the PSD by its square. A unit "
                  "without noise stays without.",
       .parameters = {noise},
       .write = write_noise},
      {.id = "gyro_bias",
       .title = "bias of a gyro",
       .physics = "A constant is added to the rate of an axis; the loop turns the aircraft against it.",
       .choices = {axes()},
       .parameters = {signed_difference("bias_deg_s", "deg/s", "added", 0.3, 1.5, 100.0)},
       .write = write_bias},
      {.id = "gyro_scale",
       .title = "scale of a gyro",
       .physics = "The rate of an axis is read as (1 + error) times itself: a row of the response.",
       .choices = {axes()},
       .parameters = {signed_difference("error", "1", "of a scale of one", 0.06, 0.2, 0.9)},
       .write = write_scale},
      {.id = "gyro_misalignment",
       .title = "misaligned gyros",
       .physics = "The unit is turned by the angle about the axis: y = (I + M) R w, a rotation of the "
                  "response's rows.",
       .choices = {axes()},
       .parameters = {signed_difference("angle_deg", "deg", "of the unit against the body", 3.0, 10.0, 90.0)},
       .write = write_misalignment},
      {.id = "gyro_quantisation",
       .title = "coarse gyros",
       .physics = "Rates are rounded to multiples of the step: white noise of variance step^2/12, values on "
                  "a lattice.",
       .parameters = {size("step_deg_s", "deg/s", "of the reading", 0.2, 1.0, 50.0)},
       .write = write_quantisation},
      {.id = "tone",
       .title = "tone in a gyro",
       .physics = "A sinusoid from elsewhere (an engine, a power supply) is added to the rate of an axis.",
       .choices = {axes()},
       .parameters = {size("amplitude_deg_s", "deg/s", "of the sinusoid", 0.2, 1.0, 100.0),
                      shape("frequency_hz", "Hz", "of the sinusoid", 1.0, 0.001, 25.0, 0.3, 2.8),
                      shape("phase_deg", "deg", "at the start", 0.0, -360.0, 360.0, 0.0, 360.0)},
       .once = true,
       .write = write_tone},
      {.id = "turbulence",
       .title = "turbulence",
       .physics = "The standard deviation of the Dryden gusts is larger or smaller by the factor: noise "
                  "spectra by its square. Calm air stays "
                  "calm.",
       .parameters = {factor("of the experiment's gusts", 0.4, 0.7, 0.05, 20.0)},
       .changes_in_flight = false,
       .write = write_turbulence},
  };
}

}  // namespace fatmc::effects
