#include "campaigns/candidates/flight_test.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "core/handling/control_loop.h"

namespace fatmc::candidates {
namespace {

constexpr double kLeadIn_s = 2.0;                                // trim before anything moves
constexpr double kShortestPause_s = 1.2, kLongestPause_s = 2.4;  // between pulses of a control
constexpr double kShortestPulse_s = 0.4, kLongestPulse_s = 0.8;
constexpr double kPulseLimit_pct = 5.0;
constexpr double kUnsteadiness_pct = 0.5;             // of a pulse, standard deviation
constexpr double kLowAmplitude = 0.2;                 // of the maximum, where a sweep begins
constexpr double kWander = 0.1, kWanderTime_s = 4.0;  // of frequency and amplitude

/// First-order Gauss-Markov process of unit variance.
class Wander {
 public:
  Wander(const TrialSeed& seed, const std::string& name, double time_constant_s, double step_s)
      : stream_(seed, name), keep_(std::exp(-step_s / time_constant_s)), value_(stream_.normal()) {}
  double next() {
    const double now = value_;
    value_ = keep_ * value_ + std::sqrt(1.0 - keep_ * keep_) * stream_.normal();
    return now;
  }

 private:
  RandomStream stream_;
  double keep_, value_;
};

/// One control's holding pulses.
class PulsePilot {
 public:
  PulsePilot(const TrialSeed& seed, const std::string& name) : stream_(seed, name) { pause(0.0); }

  /// `wanted`: what a continuous pilot would command now, per cent.
  double command(double time_s, double wanted) {
    if (time_s >= end_s_ && holding_) {
      holding_ = false;
      pause(time_s);
    }
    if (!holding_ && time_s >= begin_s_) {
      holding_ = true;
      end_s_ = time_s + kShortestPulse_s + (kLongestPulse_s - kShortestPulse_s) * stream_.uniform();
      const double size = wanted + kUnsteadiness_pct * stream_.normal();
      size_ = std::clamp(size, -kPulseLimit_pct, kPulseLimit_pct);
    }
    return holding_ ? size_ : 0.0;
  }

 private:
  void pause(double now_s) {
    begin_s_ = now_s + kShortestPause_s + (kLongestPause_s - kShortestPause_s) * stream_.uniform();
  }
  RandomStream stream_;
  double begin_s_ = 0.0, end_s_ = 0.0, size_ = 0.0;
  bool holding_ = false;
};

/// What holds the reference, per cent, from u v w p q r phi theta: pulses last a quarter of the time, so the
/// gains are above those of the SCAS.
std::array<double, kInputs> holding_command(const Eigen::VectorXd& y) {
  return {-100.0 * y(7) - 60.0 * y(4) + 0.6 * y(0), -80.0 * y(6) - 30.0 * y(3) - 0.3 * y(1),
          -80.0 * y(5) + 0.5 * y(1), 1.0 * y(2)};
}

/// What the pilot does at each sample apart from holding.
std::vector<double> sweep_command(const FlightTest& test, int control, const TrialSeed& seed,
                                  const std::string& name, double step_s) {
  Wander frequency(seed, name + " frequency", kWanderTime_s, step_s);
  Wander amplitude(seed, name + " amplitude", kWanderTime_s, step_s);
  const double maximum = test.sweep_amplitude_pct[static_cast<std::size_t>(control)];
  const double length = test.sweep_samples * step_s - 2.0 * kLeadIn_s;
  std::vector<double> out;
  double phase = 0.0;
  for (int k = 0; k < test.sweep_samples; ++k) {
    const double progress = (k * step_s - kLeadIn_s) / length;
    const double unsteady_f = 1.0 + kWander * frequency.next(), unsteady_a = 1.0 + kWander * amplitude.next();
    if (progress < 0.0 || progress > 1.0) {
      out.push_back(0.0);
      continue;
    }
    const double size = maximum * (kLowAmplitude + (1.0 - kLowAmplitude) * progress) * unsteady_a;
    out.push_back(std::clamp(size * std::sin(phase), -maximum, maximum));
    const double f = test.sweep_low_hz * std::pow(test.sweep_high_hz / test.sweep_low_hz, progress);
    phase += 2.0 * std::numbers::pi * f * unsteady_f * step_s;
  }
  return out;
}

std::vector<double> multistep_command(const FlightTest& test, int control, double sign, double step_s) {
  const double size = sign * test.multistep_amplitude_pct[static_cast<std::size_t>(control)];
  std::vector<double> out;
  for (int k = 0; k < test.multistep_samples; ++k) {
    const double units = (k * step_s - kLeadIn_s) / test.multistep_unit_s;
    const bool up = (units >= 0.0 && units < 3.0) || (units >= 5.0 && units < 6.0);
    const bool down = (units >= 3.0 && units < 5.0) || (units >= 6.0 && units < 7.0);
    out.push_back(up ? size : (down ? -size : 0.0));
  }
  return out;
}

Maneuver fly(const Truth& truth, const FlightTest& test, int control, const std::vector<double>& command,
             bool hold_by_pulses, const TrialSeed& seed, const std::string& name) {
  const double step_s = 1.0 / truth.rate_hz;
  const auto samples = static_cast<Eigen::Index>(command.size());
  RandomStream noise(seed, name + " noise");
  std::vector<Wander> gusts;
  for (const char* axis : {" gust u", " gust v", " gust w"})
    gusts.emplace_back(seed, name + axis, test.gust_time_constant_s, step_s);
  std::vector<PulsePilot> pilots;
  for (int i = 0; i < kInputs; ++i) pilots.emplace_back(seed, name + " pulses " + std::to_string(i));
  const Eigen::MatrixXd& a = truth.model.a;
  const Eigen::Index n = a.rows();
  const Eigen::MatrixXd from_gust = -(a - Eigen::MatrixXd::Identity(n, n)).leftCols(3);
  const Eigen::MatrixXd gain = test.scas * act_fhs_gain();
  Maneuver out{Eigen::MatrixXd(samples, kInputs), Eigen::MatrixXd(samples, kOutputs)};
  Eigen::VectorXd x = Eigen::VectorXd::Zero(n), y = Eigen::VectorXd::Zero(kOutputs), measured = y;
  for (Eigen::Index t = 0; t < samples; ++t) {
    Eigen::Vector3d gust;
    for (std::size_t i = 0; i < 3; ++i) gust(static_cast<Eigen::Index>(i)) = test.gust_m_s * gusts[i].next();
    Eigen::VectorXd u = -gain * measured;                            // of the sample before,
    const std::array<double, kInputs> holding = holding_command(y);  // as is what the pilot acts on
    y = truth.model.c * x;
    y.head<3>() -= gust;  // H (2b): airspeed components, the states are speeds over ground
    for (Eigen::Index i = 0; i < kInputs; ++i) {
      const auto at = static_cast<std::size_t>(i);
      if (hold_by_pulses) u(i) += pilots[at].command(static_cast<double>(t) * step_s, holding[at]);
    }
    u(control) += command[static_cast<std::size_t>(t)];
    for (Eigen::Index i = 0; i < kOutputs; ++i)
      measured(i) = y(i) + test.noise[static_cast<std::size_t>(i)] * noise.normal();
    out.inputs.row(t) = u.transpose();
    out.outputs.row(t) = measured.transpose();
    x = (a * x + truth.model.b * u + from_gust * gust).eval();
  }
  return out;
}

}  // namespace

FlownTest fly_test(const Truth& truth, const FlightTest& test, const TrialSeed& seed) {
  FlownTest out;
  const double step_s = 1.0 / truth.rate_hz;
  for (int control = 0; control < kInputs; ++control) {
    for (int second = 0; second < 2; ++second) {
      const std::string number = std::to_string(2 * control + second);
      const std::string sweep = "sweep " + number, multistep = "multistep " + number;
      out.sweeps.push_back(
          fly(truth, test, control, sweep_command(test, control, seed, sweep, step_s), true, seed, sweep));
      out.multisteps.push_back(fly(truth, test, control,
                                   multistep_command(test, control, second == 0 ? 1.0 : -1.0, step_s), false,
                                   seed, multistep));
    }
  }
  return out;
}

FlownTest recorded_test(const Truth& truth, const FlightTest& test, const TrialSeed& seed) {
  FlownTest out = fly_test(truth, test, seed);
  remove_offsets(out.sweeps, OffsetRemoval::mean);
  remove_offsets(out.multisteps, OffsetRemoval::first);
  return out;
}

}  // namespace fatmc::candidates
