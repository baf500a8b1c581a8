#include <cmath>
#include <numeric>
#include <utility>

#include "campaigns/base/prepared_trials.h"
#include "campaigns/bias/error_runs.h"
#include "campaigns/bias/summary.h"
#include "campaigns/flown/flown_flights.h"
#include "core/accuracy/response_accuracy.h"

namespace fatmc::bias {
namespace {

plot::Panel panel_over_frequency(std::string title, std::string label) {
  plot::Panel panel;
  panel.title = std::move(title);
  panel.x.label = "Frequency (Hz)";
  panel.x.scale = plot::Scale::logarithmic;
  panel.y.label = std::move(label);
  return panel;
}

plot::Points crosses(const std::string& name, const std::vector<double>& x, const std::vector<double>& y) {
  plot::Points out;
  out.name = name;
  out.x = x;
  out.y = y;
  out.hue = plot::Hue::orange;
  out.radius_px = 1.2;
  return out;
}

// Fig. 4-1: nominal and estimated magnitude with the error beside them; the error's phase.
plot::Figure responses(const ErrorRuns& runs, const std::vector<MeanError>& errors,
                       const std::vector<Eigen::Matrix3cd>& truth) {
  plot::Figure figure;
  figure.title = "Nominal and estimated response";
  figure.columns = 2;
  figure.panel_width = 420.0;
  const std::vector<double>& f = runs.frequency_hz;
  for (std::size_t r = 0; r < kResponses.size(); ++r) {
    plot::Panel panel = panel_over_frequency(std::string(kResponses[r].name), "Magnitude (dB)");
    std::vector<double> nominal, estimate;
    for (std::size_t k = 0; k < f.size(); ++k) {
      nominal.push_back(magnitude_error_db(truth[k](kResponses[r].output, kResponses[r].input)));
      estimate.push_back(nominal.back() + errors[r].magnitude_db[k]);
    }
    panel.marks.emplace_back(plot::Line{"estimate, mean of the runs", f, estimate, plot::Hue::blue});
    panel.marks.emplace_back(plot::Line{"nominal", f, nominal, plot::Hue::purple, plot::Dash::dashed});
    panel.marks.emplace_back(crosses("error", f, errors[r].magnitude_db));
    figure.panels.push_back(std::move(panel));
  }
  for (std::size_t r = 0; r < kResponses.size(); ++r) {
    plot::Panel panel = panel_over_frequency("", "Phase error (deg)");
    panel.marks.emplace_back(crosses("error", f, errors[r].phase_deg));
    figure.panels.push_back(std::move(panel));
  }
  return figure;
}

// Fig. 4-2: the errors inside the envelopes of unnoticed dynamics.
plot::Figure envelopes(const ErrorRuns& runs, const std::vector<MeanError>& errors) {
  plot::Figure figure;
  figure.title = "Error response within the limits of unnoticed dynamics";
  figure.columns = 2;
  figure.panel_width = 420.0;
  const std::vector<double>& f = runs.frequency_hz;
  std::vector<double> upper_db, lower_db, upper_deg, lower_deg;
  for (const double frequency : f) {
    const UnnoticedDynamics limits = unnoticed_dynamics(frequency);
    upper_db.push_back(limits.upper_db);
    lower_db.push_back(limits.lower_db);
    upper_deg.push_back(limits.upper_deg);
    lower_deg.push_back(limits.lower_deg);
  }
  const auto add = [&](std::string title, const char* label, const std::vector<double>& error,
                       const std::vector<double>& upper, const std::vector<double>& lower) {
    plot::Panel panel = panel_over_frequency(std::move(title), label);
    panel.marks.emplace_back(crosses("error", f, error));
    for (const auto* limit : {&upper, &lower})
      panel.marks.emplace_back(
          plot::Line{"MUAD (unverified)", f, *limit, plot::Hue::grey, plot::Dash::dashed});
    figure.panels.push_back(std::move(panel));
  };
  for (std::size_t r = 0; r < kResponses.size(); ++r)
    add(std::string(kResponses[r].name), "Magnitude error (dB)", errors[r].magnitude_db, upper_db, lower_db);
  for (std::size_t r = 0; r < kResponses.size(); ++r)
    add("", "Phase error (deg)", errors[r].phase_deg, upper_deg, lower_deg);
  return figure;
}

}  // namespace

Result<std::vector<StudyFigure>> figures(const CampaignSpec& spec, const RowSource& rows) {
  std::vector<StudyFigure> out;
  if (spec.cells.empty()) return out;
  const ErrorRuns runs = error_runs(0, rows);
  if (runs.runs() == 0) return out;
  auto own = spec_of_cell(spec, 0);
  if (!own) return fail(own.error());
  auto cell = decode_flown_cell(*own, 0);
  if (!cell) return fail(cell.error());
  auto flights = FlownFlights::prepare(*own, 0, std::move(*cell));
  if (!flights) return fail(flights.error());

  std::vector<std::size_t> all(runs.runs());
  std::iota(all.begin(), all.end(), std::size_t{0});
  std::vector<MeanError> errors;
  for (std::size_t r = 0; r < kResponses.size(); ++r) errors.push_back(mean_error(runs, r, all));
  const std::string of = "Mean of " + std::to_string(runs.runs()) + " runs in calm air, lines 0.01 Hz apart";
  out.push_back(
      {"Fig. 4-1",
       of + ", against the response of the model that flew (dashed). Errors are largest at the phugoid "
            "(0.082 Hz) and at the zero of r/zeta (0.05 Hz).",
       responses(runs, errors, (*flights)->truth())});
  out.push_back(
      {"Fig. 4-2",
       of + ": error response and the envelopes of dynamics that pilots do not notice, whose constants are "
            "quoted from memory.",
       envelopes(runs, errors)});
  return out;
}

}  // namespace fatmc::bias
