// Rate gyros of an inertial measurement unit (T A.5).
//
//   y = Q( b + (I + M_sf + M_ma) w + v ),   v white with standard deviation N sqrt(sample rate)
// (A.1 prints M_sf without the identity; its values, parts per million, are errors of a scale of one.) Q
// saturates at the range and rounds to multiples of 2 range / 2^bits (A.3).
#pragma once

#include <array>
#include <string>

#include "core/random/random_stream.h"

namespace fatmc {

struct Imu {
  std::string grade;
  std::array<double, 3> bias_rad_s{};
  std::array<double, 3> scale_error{};       ///< diagonal of M_sf
  std::array<double, 6> misalignment_rad{};  ///< M_xy, M_xz, M_yx, M_yz, M_zx, M_zy
  double noise_rad_sqrt_s = 0.0;             ///< N, angle random walk: rad/s per sqrt(Hz), two-sided
  double range_rad_s = 0.0;                  ///< 0: neither saturation nor quantisation
  int bits = 0;
  double coarse_step_rad_s = 0.0;  ///< rounds to multiples of this instead, if it is coarser

  /// 2 range / 2^bits or the coarse step, or 0.
  [[nodiscard]] double quantum() const;
  bool operator==(const Imu&) const = default;
};

/// The unit sampled at a fixed rate, constants taken out of the loop.
class Gyro {
 public:
  Gyro(const Imu& imu, double sample_rate_hz);
  /// One sample of the rates; draws three normals.
  [[nodiscard]] std::array<double, 3> sample(const std::array<double, 3>& rates, RandomStream& random) const;
  [[nodiscard]] double noise_rad_s() const { return noise_; }

 private:
  std::array<double, 3> bias_{};
  std::array<std::array<double, 3>, 3> matrix_{};
  double noise_ = 0.0;
  double range_ = 0.0;
  double quantum_ = 0.0;
  double inverse_quantum_ = 0.0;
};

}  // namespace fatmc
