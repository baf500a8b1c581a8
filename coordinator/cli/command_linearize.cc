// fatmc linearize MODEL: linear dynamics about trim, as tables or JSON.
#include <cstdio>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "campaigns/models/fat_published.h"
#include "coordinator/cli/command.h"
#include "coordinator/input/aircraft_file.h"
#include "core/base/text.h"
#include "core/flight/linear_model.h"
#include "core/flight/step_parts.h"

namespace fatmc::cli {
namespace {

using Complex = std::complex<double>;
using Json = nlohmann::ordered_json;
constexpr double kTickSeconds = 0.02;

struct Linearization {
  Aircraft aircraft;
  Trim trim;
  LinearModel continuous, sampled;
  std::vector<std::string> not_linear;
};

Result<Linearization> linearization(const std::string& path) {
  Result<TrimmedAircraft> read = read_trimmed_aircraft(path);
  if (!read) return fail(read.error());
  const LinearModel continuous = linearize(read->aircraft, read->trim);
  const int steps = parts_of_step(read->aircraft, continuous, kTickSeconds);
  return Linearization{read->aircraft, read->trim, continuous,
                       sample(read->aircraft, read->trim, kTickSeconds, steps), read->not_linear};
}

template <typename Matrix>
Json rows(const Matrix& m) {
  Json out = Json::array();
  for (Eigen::Index i = 0; i < m.rows(); ++i) {
    Json row = Json::array();
    for (Eigen::Index j = 0; j < m.cols(); ++j) row.push_back(m(i, j));
    out.push_back(row);
  }
  return out;
}

Json pairs(const std::vector<Complex>& values) {
  Json out = Json::array();
  for (const Complex& value : values) out.push_back({value.real(), value.imag()});
  return out;
}

void print_json(const Linearization& of) {
  Json out;
  out["states"] = kLinearStateNames;
  out["inputs"] = kInputNames;
  out["outputs"] = kOutputNames;
  out["A"] = rows(of.continuous.a);
  out["B"] = rows(of.continuous.b);
  out["C"] = rows(of.continuous.c);
  out["D"] = rows(of.continuous.d);
  out["poles"] = pairs(of.continuous.poles());
  Json zeros = Json::object();
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const std::string element = std::string(kOutputNames[static_cast<std::size_t>(i)]) + "/" +
                                  std::string(kInputNames[static_cast<std::size_t>(j)]);
      zeros[element] = pairs(of.continuous.zeros(i, j));
    }
  }
  out["zeros"] = zeros;
  out["sampled"] = {{"rate_hz", 1.0 / kTickSeconds},
                    {"A", rows(of.sampled.a)},
                    {"B", rows(of.sampled.b)},
                    {"C", rows(of.sampled.c)},
                    {"D", rows(of.sampled.d)}};
  if (!of.not_linear.empty()) out["effects_not_shown"] = of.not_linear;
  std::cout << out.dump() << "\n";
}

Complex nearest(const std::vector<Complex>& values, Complex wanted) {
  Complex best = values.empty() ? Complex(std::nan(""), 0.0) : values.front();
  for (const Complex& value : values) {
    if (std::abs(value - wanted) < std::abs(best - wanted)) best = value;
  }
  return best;
}

double frequency_hz(Complex s) { return std::abs(s) / (2.0 * kPi); }
double damping(Complex s) { return -s.real() / std::abs(s); }

/// One row of Tables: what is printed, what the model has, how far apart.
void print_mode(const fat_published::TableEntry& entry, Complex s, double wanted_hz) {
  std::printf("  %-15s %9.4f Hz %9.4f Hz %+8.2f %%", std::string(entry.name).c_str(), wanted_hz,
              frequency_hz(s), 100.0 * (frequency_hz(s) / wanted_hz - 1.0));
  if (entry.damping != 0.0) std::printf("   damping %6.3f %7.4f", entry.damping, damping(s));
  std::printf("\n");
}

void print_beside_published(const Linearization& of) {
  namespace published = fat_published;
  const std::vector<Complex> poles = of.continuous.poles();
  const std::vector<Complex> pitch_zeros = of.continuous.zeros(1, 1);
  const auto pole = [&](std::size_t i) {
    return nearest(poles, published::continuous(published::kTableA5[i]));
  };
  const auto row = [](const auto& table, std::size_t i, Complex s) {
    print_mode(table[i], s, table[i].frequency_hz);
  };
  std::printf("Table A-1, longitudinal   published         ours  deviation\n");
  row(published::kTableA1, 0, pole(1));
  row(published::kTableA1, 1, nearest(pitch_zeros, -published::kTheta1));
  row(published::kTableA1, 2, pole(4));
  row(published::kTableA1, 3, nearest(pitch_zeros, -2.0 * kPi * published::kTableA1[3].frequency_hz));
  std::printf(
      "  T_theta1: no plausible set of derivatives found that meets it, campaigns/models/README.md says "
      "why\n");
  std::printf(
      "\nTable A-2, lateral        published         ours  deviation (spiral: printed as a bound, \"<\")\n");
  row(published::kTableA2, 0, pole(0));
  row(published::kTableA2, 1, pole(5));
  row(published::kTableA2, 2, pole(2));
  row(published::kTableA2, 3,
      nearest(of.continuous.zeros(2, 0), -2.0 * kPi * published::kTableA2[3].frequency_hz));
  const double pair = 2.0 * kPi * published::kTableA2[4].frequency_hz;
  row(published::kTableA2, 4, nearest(of.continuous.zeros(2, 2), Complex(-0.199 * pair, 0.98 * pair)));

  std::printf("\nTable A-5, poles; s = ln(z)/0.02 of the printed z, 1/s\n");
  std::printf("  %-17s %27s %27s  %s\n", "", "published", "ours", "|difference|/|s|");
  for (const auto& entry : published::kTableA5) {
    const Complex wanted = published::continuous(entry);
    const Complex ours = nearest(poles, wanted);
    std::printf("  %-17s %13.7f %+12.7fj %13.7f %+12.7fj  %.1e\n", std::string(entry.mode).c_str(),
                wanted.real(), wanted.imag(), ours.real(), ours.imag(),
                std::abs(ours - wanted) / std::abs(wanted));
  }
  std::printf("  Two actuator pairs are printed; aileron, left and right ruddervator are three here.\n");
}

void print_text(const Linearization& of) {
  std::printf(
      "%s, level flight at %s m/s: angle of attack %.4f deg, elevator %.2e rad, throttle %.4f, thrust %.3f "
      "N\n",
      of.aircraft.name.c_str(), shortest(of.aircraft.speed_m_s).c_str(), of.trim.alpha_rad * 180.0 / kPi,
      of.trim.eta_rad, of.trim.throttle, of.trim.thrust_n);
  std::printf("trim: %d iterations, residual %.1e\n", of.trim.iterations, of.trim.residual);
  for (const std::string& effect : of.not_linear) {
    std::printf("not in the linear airframe: %s (fatmc simulate flies it)\n", effect.c_str());
  }
  std::printf("\n");
  if (of.aircraft.name == "FAT") {
    print_beside_published(of);
    std::printf("\n");
  }
  std::printf("Poles, 1/s\n");
  for (const Complex& s : of.continuous.poles()) {
    std::printf("  %13.7f %+13.7fj   %9.5f Hz   damping %8.5f\n", s.real(), s.imag(), frequency_hz(s),
                damping(s));
  }
  std::printf("\nZeros, 1/s\n");
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      std::printf("  %s/%-7s", std::string(kOutputNames[static_cast<std::size_t>(i)]).c_str(),
                  std::string(kInputNames[static_cast<std::size_t>(j)]).c_str());
      const std::vector<Complex> zeros = of.continuous.zeros(i, j);
      if (zeros.empty()) std::printf(" none");
      for (const Complex& s : zeros) std::printf(" %.5g%+.5gj", s.real(), s.imag());
      std::printf("\n");
    }
  }
}

}  // namespace

void add_linearize_command(CLI::App& app, Exit& exit) {
  CLI::App* command = app.add_subcommand("linearize", "poles, zeros and matrices of a model about its trim");
  const auto path = std::make_shared<std::string>();
  const auto format = std::make_shared<std::string>("text");
  command->add_option("MODEL", *path, "model file, kind = \"aircraft\"")->required();
  command->add_option("--format", *format, "text or json")->check(CLI::IsMember({"text", "json"}));
  command->footer(
      "Text puts the FAT's poles and zeros beside Tables A-1, A-2 and A-5 of the thesis; json gives the "
      "matrices too.\n"
      "Example: fatmc linearize campaigns/models/fat.toml --format json");
  command->callback([path, format, &exit] {
    const Result<Linearization> result = linearization(*path);
    if (!result) {
      exit = report(result.error());
    } else if (*format == "json") {
      print_json(*result);
    } else {
      print_text(*result);
    }
  });
}

}  // namespace fatmc::cli
