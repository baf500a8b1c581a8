#include "core/flight/imu.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fatmc {

double Imu::quantum() const {
  return std::max(range_rad_s > 0.0 ? std::ldexp(range_rad_s, 1 - bits) : 0.0, coarse_step_rad_s);
}

Gyro::Gyro(const Imu& imu, double sample_rate_hz)
    : bias_(imu.bias_rad_s),
      noise_(imu.noise_rad_sqrt_s * std::sqrt(sample_rate_hz)),
      range_(imu.range_rad_s > 0.0 ? imu.range_rad_s : std::numeric_limits<double>::infinity()),
      quantum_(imu.quantum()),
      inverse_quantum_(quantum_ > 0.0 ? 1.0 / quantum_ : 0.0) {
  std::size_t next = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      matrix_[i][j] = i == j ? 1.0 + imu.scale_error[i] : imu.misalignment_rad[next++];
    }
  }
}

std::array<double, 3> Gyro::sample(const std::array<double, 3>& rates, RandomStream& random) const {
  std::array<double, 3> out;
  for (std::size_t i = 0; i < 3; ++i) {
    const double value = bias_[i] + matrix_[i][0] * rates[0] + matrix_[i][1] * rates[1] +
                         matrix_[i][2] * rates[2] + noise_ * random.normal();
    // std::clamp lets a NaN through, so that a diverged state stays visible.
    out[i] = quantum_ > 0.0 ? std::nearbyint(std::clamp(value, -range_, range_) * inverse_quantum_) * quantum_
                            : value;
  }
  return out;
}

}  // namespace fatmc
