#include "core/flight/flight.h"

#include <cmath>
#include <vector>

#include "core/base/text.h"

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

/// What controller, sensors and limits want to know about the plant at a tick.
struct Observation {
  std::array<double, 3> rates;
  std::array<double, 3> velocity;  ///< over ground
  double phi, theta;
  double level_turn;  ///< sin(phi) cos(theta)
};

/// Limits of the flow angles as what velocities compare with.
struct AngleLimits {
  explicit AngleLimits(const Validity& v)
      : tan_alpha_min(std::tan(v.alpha_min_rad)),
        tan_alpha_max(std::tan(v.alpha_max_rad)),
        sin_beta_max(std::sin(v.beta_max_rad)) {}
  double tan_alpha_min, tan_alpha_max, sin_beta_max;
};

/// Where the model stops being valid. Comparisons are written so that a NaN fails them.
Ending judge(const Validity& limits, const AngleLimits& angles, const Observation& at,
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

/// Counts of limited servos.
struct LimitCount {
  std::array<std::int64_t, 3> position{}, rate{};
  std::int64_t looks = 0;
  void look(const FlightConstants& k, const double* positions, const double* rates) {
    ++looks;
    for (std::size_t i = 0; i < 3; ++i) {
      position[i] += std::abs(positions[i]) >= k.position_limit[i];
      rate[i] += std::abs(rates[i]) >= k.rate_limit[i];
    }
  }
};

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

/// The full equations of motion.
class Flight::NonlinearPlant {
 public:
  explicit NonlinearPlant(const Flight& flight)
      : flight_(flight), x_(flight.trim_.state), step_s_(flight.tick_s_ / flight.steps_per_tick_) {}

  [[nodiscard]] Observation observe() const {
    const std::array<double, 3> down = down_in_body(x_);
    return {{x_[state::rates], x_[state::rates + 1], x_[state::rates + 2]},
            {x_[state::velocity], x_[state::velocity + 1], x_[state::velocity + 2]},
            std::atan2(down[1], down[2]),
            std::asin(std::clamp(-down[0], -1.0, 1.0)),
            down[1]};
  }

  /// One tick; `node(i, rates)` is told the rates after Runge-Kutta step i.
  template <typename Node>
  void advance(const std::array<double, 3>& command, const Gust<double>& gust, LimitCount& count, Node node) {
    Demand<double> demand;
    demand.surfaces = mix(flight_.constants_, command, flight_.trim_.demand.surfaces);
    demand.throttle = flight_.trim_.demand.throttle;
    for (int i = 0; i < flight_.steps_per_tick_; ++i) {
      rk4_step(flight_.constants_, demand, gust, step_s_, x_);
      count.look(flight_.constants_, &x_[state::surfaces], &x_[state::surface_rates]);
      node(i, &x_[state::rates]);
    }
  }
  [[nodiscard]] int nodes() const { return flight_.steps_per_tick_; }

 private:
  const Flight& flight_;
  State<double> x_;
  double step_s_;
};

/// The sampled linear step map, in deviations from trim.
class Flight::LinearPlant {
 public:
  explicit LinearPlant(const Flight& flight) : flight_(flight) { x_.setZero(); }

  [[nodiscard]] Observation observe() const {
    const double theta = flight_.trim_.alpha_rad + x_[7];
    const State<double>& trim = flight_.trim_.state;
    return {
        {x_[3], x_[4], x_[5]},
        {trim[state::velocity] + x_[0], trim[state::velocity + 1] + x_[1], trim[state::velocity + 2] + x_[2]},
        x_[6],
        theta,
        std::sin(x_[6]) * std::cos(theta)};
  }

  template <typename Node>
  void advance(const std::array<double, 3>& command, const Gust<double>& gust, LimitCount& count, Node node) {
    const LinearModel& map = flight_.sampled_;
    Eigen::Matrix<double, 6, 1> g;
    g << gust.velocity[0], gust.velocity[1], gust.velocity[2], gust.rates[0], gust.rates[1], gust.rates[2];
    const Eigen::Matrix<double, kLinearStates, 1> next =
        map.a * x_ + map.b * Eigen::Map<const Eigen::Vector3d>(command.data()) + map.e * g;
    x_ = next;
    std::array<double, 3> position;
    for (std::size_t i = 0; i < 3; ++i) position[i] = flight_.trim_.demand.surfaces[i] + x_[10 + i];
    count.look(flight_.constants_, position.data(), x_.data() + 13);
    node(0, x_.data() + 3);
  }
  [[nodiscard]] int nodes() const { return 1; }

 private:
  const Flight& flight_;
  Eigen::Matrix<double, kLinearStates, 1> x_;
};

Flight::Flight(const Aircraft& aircraft, const FlightSetup& setup, Trim trim)
    : aircraft_(aircraft),
      setup_(setup),
      trim_(std::move(trim)),
      constants_(aircraft),
      tick_s_(1.0 / setup.rate_hz),
      steps_per_tick_(parts(tick_s_, setup.step_s)),
      imu_samples_(parts(tick_s_, setup.imu_step_s)),
      continuous_(linearize(aircraft, trim_)),
      sampled_(sample(aircraft, trim_, tick_s_, steps_per_tick_)),
      dryden_(setup.turbulence_m_s, aircraft.speed_m_s, aircraft.span_m, tick_s_),
      gyro_(setup.imu, imu_samples_ / tick_s_) {}

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

template <typename PlantType>
void Flight::fly_plant(PlantType plant, const Eigen::Ref<const Eigen::MatrixX3d>& reference,
                       const TrialSeed& trial, FlightRecord& record) const {
  RandomStream gust_noise(trial, "turbulence");
  RandomStream imu_noise(trial, "imu");
  const bool windy = setup_.turbulence_m_s > 0.0;
  Dryden::StateVector air{};
  if (windy && !setup_.gusts_from_calm) air = dryden_.start(gust_noise);
  const AngleLimits angles(aircraft_.validity);
  LimitCount count;
  std::array<double, 3> square_sum{};
  // Rates at the nodes of the last tick, its begin included; only an averaging unit reads them.
  const int nodes = plant.nodes();
  std::vector<std::array<double, 3>> node_rates(static_cast<std::size_t>(nodes) + 1, plant.observe().rates);

  const Eigen::Index n = reference.rows();
  for (Eigen::Index t = 0; t < n; ++t) {
    Gust<double> gust;
    if (windy) {
      const Dryden::Gusts g = dryden_.gusts(air);
      const double side = setup_.gusts == FlightSetup::Gusts::all ? 1.0 : 0.0;
      gust = {{g[0], side * g[1], g[2]}, {side * g[3], g[4], side * g[5]}};
      dryden_.advance(air, gust_noise);
    }
    const Observation at = plant.observe();
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
      y = gyro_.sample(at.rates, imu_noise);
    } else {
      for (int s = 1; s <= imu_samples_; ++s) {
        const double place = static_cast<double>(s) * nodes / imu_samples_;
        const auto before = std::min(static_cast<std::size_t>(place), static_cast<std::size_t>(nodes) - 1);
        const double share = place - static_cast<double>(before);
        std::array<double, 3> rates;
        for (std::size_t i = 0; i < 3; ++i) {
          rates[i] = (1.0 - share) * node_rates[before][i] + share * node_rates[before + 1][i];
        }
        const std::array<double, 3> one = gyro_.sample(rates, imu_noise);
        for (std::size_t i = 0; i < 3; ++i) y[i] += one[i] / imu_samples_;
      }
      node_rates[0] = at.rates;
    }

    std::array<double, 3> command;
    for (int i = 0; i < 3; ++i) {
      const double r = reference(t, i);
      command[static_cast<std::size_t>(i)] =
          setup_.closed_loop ? setup_.gain[i] * (r - y[static_cast<std::size_t>(i)]) : r;
    }
    if (setup_.closed_loop && setup_.turn_coordinator) {
      const double ground_speed =
          std::sqrt(at.velocity[0] * at.velocity[0] + at.velocity[1] * at.velocity[1] +
                    at.velocity[2] * at.velocity[2]);
      command[2] += setup_.gain[2] * kGravity / ground_speed * at.level_turn;
    }
    for (int i = 0; i < 3; ++i) {
      const double u = command[static_cast<std::size_t>(i)];
      record.input(t, i) = u;
      record.output(t, i) = y[static_cast<std::size_t>(i)];
      square_sum[static_cast<std::size_t>(i)] += u * u;
    }
    record.auxiliary(t, 0) = at.phi;
    record.auxiliary(t, 1) = at.theta;
    record.auxiliary(t, 2) = airspeed;
    record.samples = t + 1;

    plant.advance(command, gust, count, [&](int i, const double* rates) {
      if (setup_.average_imu) node_rates[static_cast<std::size_t>(i) + 1] = {rates[0], rates[1], rates[2]};
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
  if (setup_.plant == FlightSetup::Plant::linear) {
    fly_plant(LinearPlant(*this), reference, trial, record);
  } else {
    fly_plant(NonlinearPlant(*this), reference, trial, record);
  }
}

}  // namespace fatmc
