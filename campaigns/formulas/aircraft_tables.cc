#include <cmath>
#include <complex>
#include <numbers>
#include <string>

#include "campaigns/formulas/aircraft_formulas.h"
#include "campaigns/formulas/printed_row.h"
#include "campaigns/models/fat_published.h"
#include "core/flight/flight.h"

namespace fatmc {
namespace {

using Complex = std::complex<double>;
using formulas::add_printed;
using formulas::Printed;
namespace published = fat_published;

constexpr double kTwoPi = 2.0 * std::numbers::pi;

double frequency_hz(Complex s) { return std::abs(s) / kTwoPi; }
double damping(Complex s) { return -s.real() / std::abs(s); }

Complex nearest(const std::vector<Complex>& values, Complex wanted) {
  Complex best(std::nan(""), 0.0);
  for (const Complex& value : values) {
    if (std::isnan(best.real()) || std::abs(value - wanted) < std::abs(best - wanted)) best = value;
  }
  return best;
}

struct Dynamics {
  explicit Dynamics(const LinearModel& model)
      : poles(model.poles()),
        pitch_zeros(model.zeros(1, 1)),
        roll_to_yaw_zeros(model.zeros(2, 0)),
        yaw_zeros(model.zeros(2, 2)) {}
  std::vector<Complex> poles, pitch_zeros, roll_to_yaw_zeros, yaw_zeros;

  [[nodiscard]] Complex pole(std::size_t entry) const {
    return nearest(poles, published::continuous(published::kTableA5[entry]));
  }
};

/// Frequency, time constant 1/f and damping of one entry of Table.
void add_entry(std::vector<TableRow>& rows, const char* table, const published::TableEntry& entry, Complex s,
               const std::string& otherwise) {
  const std::string name(entry.name);
  const double f = frequency_hz(s);
  if (entry.bound) {
    add_printed(rows, table, name, "frequency", "Hz", {entry.frequency_hz, entry.frequency_digits}, f, "");
    formulas::judge_bound(rows.back(), true, otherwise);
    add_printed(rows, table, name, "time constant, 1/f", "s", {entry.time_constant_s, entry.time_digits},
                1.0 / f, "");
    formulas::judge_bound(rows.back(), false, otherwise);
  } else {
    add_printed(rows, table, name, "frequency", "Hz", {entry.frequency_hz, entry.frequency_digits}, f,
                otherwise);
    formulas::same_order_is_shape(rows.back());
    add_printed(rows, table, name, "time constant, 1/f", "s", {entry.time_constant_s, entry.time_digits},
                1.0 / f, otherwise);
    formulas::same_order_is_shape(rows.back());
  }
  if (entry.damping == 0.0) return;
  add_printed(rows, table, name, "damping", "", {entry.damping, entry.damping_digits}, damping(s), otherwise);
  formulas::same_order_is_shape(rows.back());
}

void add_table_a_1(const Dynamics& of, std::vector<TableRow>& rows) {
  const auto& table = published::kTableA1;
  add_entry(rows, "A-1", table[0], of.pole(1),
            "Table A-5's pole, which ours meets, has 0.0818 Hz; Table 3-1 prints 0.082");
  const Complex theta1 = nearest(of.pitch_zeros, -published::kTheta1);
  const std::string missed =
      "read as Hz it lies above the phugoid's own frequency: no plausible derivatives meet it "
      "(campaigns/models/README.md)";
  add_entry(rows, "A-1", table[1], theta1, missed);
  add_printed(
      rows, "A-1", std::string(table[1].name), "the same, 0.078 read as rad/s", "rad/s",
      {table[1].frequency_hz, table[1].frequency_digits}, std::abs(theta1),
      "needs an induced drag 2.4 times that of such a wing; the column says Hz, and 12.9 s fits both");
  formulas::same_order_is_shape(rows.back());
  add_entry(rows, "A-1", table[2], of.pole(4), "");
  add_entry(rows, "A-1", table[3], nearest(of.pitch_zeros, -kTwoPi * table[3].frequency_hz),
            "a weak target of the fit, campaigns/models/README.md");
}

void add_table_a_2(const Dynamics& of, std::vector<TableRow>& rows) {
  const auto& table = published::kTableA2;
  add_entry(rows, "A-2", table[0], of.pole(0), "");
  add_entry(rows, "A-2", table[1], of.pole(5), "Table A-5's pole, which ours meets, has 2.258 Hz");
  add_entry(rows, "A-2", table[2], of.pole(2), "");
  add_entry(rows, "A-2", table[3], nearest(of.roll_to_yaw_zeros, -kTwoPi * table[3].frequency_hz),
            "1/0.32 Hz is 3.1 s, not 3.0; the zero is a weak target of the fit");
  const double pair = kTwoPi * table[4].frequency_hz;
  const double zeta = table[4].damping;
  add_entry(rows, "A-2", table[4], nearest(of.yaw_zeros, pair * Complex(-zeta, std::sqrt(1.0 - zeta * zeta))),
            "");
}

void add_table_a_5(const Dynamics& of, std::vector<TableRow>& rows) {
  const std::string rounded =
      "the model file holds six digits; the same fit written with twelve meets all printed digits";
  for (std::size_t i = 0; i < published::kTableA5.size(); ++i) {
    const published::DiscretePole& entry = published::kTableA5[i];
    const Complex z = std::exp(of.pole(i) * published::kTick);
    const std::string name(entry.mode);
    add_printed(rows, "A-5", name, "Re z", "", {entry.re, 8}, z.real(), rounded);
    formulas::same_order_is_shape(rows.back());
    if (entry.im == 0.0) continue;
    add_printed(rows, "A-5", name, "Im z", "", {entry.im, entry.im < 0.1 ? 7 : 8}, z.imag(), rounded);
    formulas::same_order_is_shape(rows.back());
  }
}

}  // namespace

Result<std::vector<TableRow>> aircraft_tables(const AircraftModel& model) {
  const auto flight = Flight::prepare(model.aircraft, {});
  if (!flight) return fail(flight.error());
  const Dynamics dynamics(flight->continuous());
  std::vector<TableRow> rows;
  add_table_a_1(dynamics, rows);
  add_table_a_2(dynamics, rows);
  add_table_a_5(dynamics, rows);
  return rows;
}

}  // namespace fatmc
