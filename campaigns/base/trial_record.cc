#include "campaigns/base/trial_record.h"

#include "core/base/text.h"

namespace fatmc {
namespace {

std::string roles(const Experiment& experiment, const Aircraft& aircraft) {
  const Excitation& excitation = experiment.excitation;
  const FlightSetup& flight = experiment.flight;
  std::vector<std::string> lines;
  for (const int line : excitation.lines) lines.push_back(std::to_string(line));
  std::string gain;
  for (int i = 0; i < 3; ++i) {
    std::vector<std::string> row;
    for (int j = 0; j < 3; ++j) row.push_back(i == j ? shortest(flight.gain(i)) : "0.0");
    gain += (i > 0 ? ", [" : "[") + join(row) + "]";
  }
  std::string text = "# Rates in rad/s, commands in [-1, 1], angles in rad, V in m/s.\n[record]\n";
  text += "rate_hz = " + shortest(flight.rate_hz) + "\n";
  if (flight.closed_loop) text += "reference = [\"r_p\", \"r_q\", \"r_r\"]\n";
  text += "input = [\"xi_c\", \"eta_c\", \"zeta_c\"]\noutput = [\"p\", \"q\", \"r\"]\n";
  text += "auxiliary = [\"phi\", \"theta\", \"V\"]\n";
  text += "period_samples = " + std::to_string(excitation.period_samples) + "\n";
  text += "periods = " + std::to_string(excitation.periods) + "\n";
  text += "excited_lines = [" + join(lines) + "]\n";
  if (flight.closed_loop) text += "controller_gain = [" + gain + "]\n";
  text += "trim_speed_m_s = " + shortest(aircraft.speed_m_s) + "\n";
  text += "hold = \"zoh\"\n";
  return text;
}

}  // namespace

TrialRecord trial_record(const FlightRecord& flown, const Experiment& experiment, const Aircraft& aircraft) {
  const Eigen::Index n = flown.samples;
  TrialRecord out;
  out.names = {"t", "r_p", "r_q", "r_r", "xi_c", "eta_c", "zeta_c", "p", "q", "r", "phi", "theta", "V"};
  out.columns.resize(n, 13);
  for (Eigen::Index i = 0; i < n; ++i) out.columns(i, 0) = static_cast<double>(i) / experiment.flight.rate_hz;
  out.columns.middleCols(1, 3) = flown.reference.topRows(n);
  out.columns.middleCols(4, 3) = flown.input.topRows(n);
  out.columns.middleCols(7, 3) = flown.output.topRows(n);
  out.columns.middleCols(10, 3) = flown.auxiliary.topRows(n);
  out.toml = roles(experiment, aircraft);
  return out;
}

}  // namespace fatmc
