// A flight: aircraft, actuators, turbulence, gyros and rate controller over one record.
//
// At tick n (every 1/rate seconds), in this order:
//   y[n] measured; u[n] = K (r[n] - y[n]) (yaw: + K r_ct with the turn coordinator); gusts g[n];
//   u[n] and g[n] held over [n, n+1), which is flown in Runge-Kutta steps.
// So y is read before the new u acts, and y[n+1] is the first to see u[n]: the loop closes over
// G0(z) = C (zI - Phi)^-1 Gamma + D of sample() (linear_model.h).
// What lies between controller, servos, gyros and record beyond that: signal_path.h.
// Turn coordinator: r_ct = (g/V) sin(phi) cos(theta), V over ground. T 3.2 prints m where g belongs.
#pragma once

#include <Eigen/Dense>
#include <string_view>

#include "core/base/error.h"
#include "core/flight/dryden.h"
#include "core/flight/flight_stages.h"
#include "core/flight/imu.h"
#include "core/flight/linear_model.h"
#include "core/flight/signal_path.h"
#include "core/flight/trim.h"
#include "core/random/random_stream.h"

namespace fatmc {

/// What a flight goes on with from a time on: everything but environment and trim settings may change.
struct FlightStage {
  double from_s = 0.0;
  Aircraft aircraft;
  Imu imu;
  Eigen::Vector3d gain = Eigen::Vector3d::Zero();
  SignalPath path;
  bool operator==(const FlightStage&) const = default;
};

struct FlightSetup {
  double rate_hz = 50.0;  ///< of the controller and the record (T 3.2.1)
  double step_s = 0.02;   ///< Runge-Kutta step; divides the tick
  double imu_step_s =
      0.005;  ///< gyro sampling (T 3.2.4); divides the tick. Its last sample of a tick is used, ...
  bool average_imu = false;   ///< ... or the mean over the tick: a quarter of the noise, 7.5 ms of delay.
                              ///< Rates between Runge-Kutta nodes are interpolated linearly
  Imu imu;                    ///< the default measures exactly
  double turbulence_m_s = 0;  ///< sigma of Dryden turbulence; 0 is calm
  /// Gusts that the aircraft meets: all six, or u, w and q alone. The airframe is symmetric, so that without lateral gusts,
  /// lateral references and gyro noise it stays in its plane of symmetry exactly: T's "lateral states are fixed" (3.2.2).
  enum class Gusts { all, longitudinal };
  Gusts gusts = Gusts::all;
  /// Gusts at the first tick: a draw from their stationary law, or none, from which the filters fill within L/V = 22 s. A
  /// stationary draw meets an aircraft that is trimmed for calm air: above sigma = 2 m/s it may leave the model's range of
  /// angles of attack at once.
  bool gusts_from_calm = false;
  enum class Plant { nonlinear, linear };
  Plant plant = Plant::nonlinear;  ///< linear: the sampled step map, gusts through its gust input, no limits
  bool closed_loop = true;         ///< false: u = r, normalised commands
  Eigen::Vector3d gain = Eigen::Vector3d::Constant(0.1);  ///< diagonal of K, s/rad (T 5.2: 0.1; T 3.2.3: 0.5)
  bool turn_coordinator = true;
  SignalPath path;
  std::vector<FlightStage> stages;  ///< later ones, in order; the nonlinear plant alone has them
  bool operator==(const FlightSetup&) const = default;
};

/// How a flight ended.
enum class Ending {
  completed,
  not_finite,  ///< a state is NaN or infinite
  angle_of_attack,
  side_slip,
  bank,
  pitch,
  airspeed,  ///< left Aircraft::validity
};
std::string_view name(Ending ending);

/// n samples by three channels each, one channel contiguous. After a divergence the rows from `samples` on
/// are zero.
struct FlightRecord {
  Eigen::MatrixX3d reference;  ///< r: rate commands in rad/s (open loop: commands)
  Eigen::MatrixX3d input;      ///< u: normalised commands xi_c, eta_c, zeta_c
  Eigen::MatrixX3d output;     ///< y: measured p, q, r in rad/s
  Eigen::MatrixX3d auxiliary;  ///< phi, theta in rad, true airspeed in m/s; free of sensor errors
  Ending ending = Ending::completed;
  Eigen::Index samples = 0;  ///< valid rows
  double ending_time_s = 0.0;
  /// Share of Runge-Kutta steps after which a servo (aileron, left, right ruddervator) stands at its limit.
  /// The linear plant has no limits: there, share of ticks at which it exceeds them.
  Eigen::Vector3d at_position_limit = Eigen::Vector3d::Zero();
  Eigen::Vector3d at_rate_limit = Eigen::Vector3d::Zero();
  Eigen::Vector3d input_rms = Eigen::Vector3d::Zero();
};

/// Trim, linear models and noise filters, made once; `fly` is const, touches nothing shared and may run in
/// any number of threads.
class Flight {
 public:
  /// Fails on a setup that cannot be flown (step that does not divide the tick, no trim).
  static Result<Flight> prepare(const Aircraft& aircraft, const FlightSetup& setup);

  /// Flies one record of reference.rows() ticks. Streams: "turbulence" and "imu" of the trial. Equal
  /// arguments give equal bits. `record` is overwritten; its storage is reused.
  void fly(const Eigen::Ref<const Eigen::MatrixX3d>& reference, const TrialSeed& trial,
           FlightRecord& record) const;

  [[nodiscard]] const Aircraft& aircraft() const { return aircraft_; }
  [[nodiscard]] const FlightSetup& setup() const { return setup_; }
  [[nodiscard]] const Trim& trim() const { return trim_; }
  [[nodiscard]] const LinearModel& continuous() const { return continuous_; }
  /// The step map whose response is G0.
  [[nodiscard]] const LinearModel& sampled() const { return sampled_; }

 private:
  Flight(const Aircraft& aircraft, const FlightSetup& setup, Trim trim);
  template <typename PlantType, typename Path>
  void fly_plant(PlantType plant, Path path, const Eigen::Ref<const Eigen::MatrixX3d>& reference,
                 const TrialSeed& trial, FlightRecord& record) const;

  Aircraft aircraft_;
  FlightSetup setup_;
  Trim trim_;
  double tick_s_;
  int steps_per_tick_;
  int imu_samples_;
  std::vector<PreparedStage> stages_;
  bool direct_path_, rigid_;
  LinearModel continuous_, sampled_;
  std::vector<LinearModel> segment_maps_;  ///< of the linear plant
  Dryden dryden_;
};

}  // namespace fatmc
