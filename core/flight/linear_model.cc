#include "core/flight/linear_model.h"

#include <algorithm>

#include "core/flight/additional_dynamics.h"
#include "core/flight/dual.h"
#include "core/flight/zeros.h"

namespace fatmc {
namespace {

constexpr std::size_t kVariables = kLinearStates + 3 + 6;
using Scalar = Dual<kVariables>;

/// Trim with states, commands and gusts as independent variables.
struct Seeded {
  State<Scalar> x;
  Demand<Scalar> demand;
  Gust<Scalar> gust;
};

Seeded seed(const FlightConstants& k, const Trim& trim) {
  Seeded out;
  std::array<Scalar, kLinearStates> x;
  for (std::size_t i = 0; i < kLinearStates; ++i) x[i] = Scalar(0.0, i);
  out.x = displaced(trim, x);
  std::array<Scalar, 3> command;
  for (std::size_t i = 0; i < 3; ++i) {
    command[i] = Scalar(0.0, kLinearStates + i);
    out.gust.velocity[i] = Scalar(0.0, kLinearStates + 3 + i);
    out.gust.rates[i] = Scalar(0.0, kLinearStates + 6 + i);
  }
  out.demand.surfaces = mix(k, command, trim.demand.surfaces);
  out.demand.throttle = Scalar(trim.demand.throttle);
  return out;
}

/// Slopes of the new states as matrices.
LinearModel collect(const std::array<Scalar, kLinearStates>& rows) {
  LinearModel model;
  for (int i = 0; i < kLinearStates; ++i) {
    const auto& slope = rows[static_cast<std::size_t>(i)].slope;
    for (int j = 0; j < kLinearStates; ++j) model.a(i, j) = slope[static_cast<std::size_t>(j)];
    for (int j = 0; j < 3; ++j) model.b(i, j) = slope[static_cast<std::size_t>(kLinearStates + j)];
    for (int j = 0; j < 6; ++j) model.e(i, j) = slope[static_cast<std::size_t>(kLinearStates + 3 + j)];
  }
  model.c(0, 3) = model.c(1, 4) = model.c(2, 5) = 1.0;
  return model;
}

}  // namespace

LinearModel linearize(const Aircraft& aircraft, const Trim& trim) {
  const FlightConstants k(aircraft);
  const Seeded at = seed(k, trim);
  State<Scalar> dx;
  if (aircraft.additional == AdditionalPhysics{}) {
    derivative(k, at.x, at.demand, at.gust, dx);
  } else {
    derivative(k, at.x, at.demand, at.gust, dx, AdditionalDynamics(aircraft, k, false));
  }
  std::array<Scalar, kLinearStates> rows;
  for (std::size_t i = 0; i < 6; ++i) rows[i] = dx[state::velocity + i];
  for (std::size_t i = 8; i < kLinearStates; ++i) rows[i] = dx[state::propeller + i - 8];
  // Euler angle rates: dphi/dt = p + tan(theta) (q sin phi + r cos phi), dtheta/dt = q cos phi - r sin phi.
  const Scalar phi(0.0, 6);
  const Scalar theta = Scalar(0.0, 7) + trim.alpha_rad;
  const Scalar& p = at.x[state::rates];
  const Scalar& q = at.x[state::rates + 1];
  const Scalar& r = at.x[state::rates + 2];
  rows[6] = p + sin(theta) / cos(theta) * (q * sin(phi) + r * cos(phi));
  rows[7] = q * cos(phi) - r * sin(phi);
  return collect(rows);
}

LinearModel sample(const Aircraft& aircraft, const Trim& trim, double tick_s, int steps) {
  const FlightConstants k(aircraft);
  Seeded at = seed(k, trim);
  if (aircraft.additional == AdditionalPhysics{}) {
    for (int i = 0; i < steps; ++i) rk4_step(k, at.demand, at.gust, tick_s / steps, at.x);
  } else {
    const AdditionalDynamics dynamics(aircraft, k, false);
    for (int i = 0; i < steps; ++i) rk4_step(k, at.demand, at.gust, tick_s / steps, at.x, dynamics);
  }
  LinearModel model = collect(displacement(trim, at.x));
  model.sample_time_s = tick_s;
  return model;
}

namespace {

using ComplexStateMatrix = Eigen::Matrix<std::complex<double>, kLinearStates, kLinearStates>;

/// lambda I - A
ComplexStateMatrix pencil_at(const LinearModel& model, double frequency_hz) {
  using Complex = std::complex<double>;
  const double angle = 2.0 * kPi * frequency_hz;
  const Complex lambda =
      model.sample_time_s > 0.0 ? std::polar(1.0, angle * model.sample_time_s) : Complex(0.0, angle);
  ComplexStateMatrix pencil = -model.a.cast<Complex>();
  pencil.diagonal().array() += lambda;
  return pencil;
}

}  // namespace

Eigen::Matrix3cd LinearModel::response(double frequency_hz) const {
  using Complex = std::complex<double>;
  return c.cast<Complex>() * pencil_at(*this, frequency_hz).partialPivLu().solve(b.cast<Complex>()) +
         d.cast<Complex>();
}

Eigen::Matrix<std::complex<double>, 3, 6> LinearModel::gust_response(double frequency_hz) const {
  using Complex = std::complex<double>;
  return c.cast<Complex>() * pencil_at(*this, frequency_hz).partialPivLu().solve(e.cast<Complex>());
}

std::vector<std::complex<double>> LinearModel::poles() const { return sorted_eigenvalues(a); }

std::vector<std::complex<double>> LinearModel::zeros(int output, int input) const {
  return transmission_zeros(a, b.col(input), c.row(output), d(output, input));
}

}  // namespace fatmc
