#include "coordinator/cli/estimate_plots.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "coordinator/plot/phase_curve.h"
#include "core/accuracy/response_accuracy.h"
#include "core/base/text.h"
#include "core/stats/confidence.h"

namespace fatmc::cli {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi, kNone = std::numeric_limits<double>::quiet_NaN();
constexpr double kLevel = 0.95;
constexpr int kMostDots = 150;  // more lines than this are a curve of their own

double decibel(double magnitude) { return magnitude > 0.0 ? 20.0 * std::log10(magnitude) : kNone; }
double phase_deg(std::complex<double> g) { return std::arg(g) * kDegrees; }

/// One element along the lines that hold it.
struct Element {
  std::vector<double> f, db, deg, radius, magnitude;
  std::vector<double> border_f, border_db, border_deg;
};

/// Radius of the region, in deviations.
double region_factor(const EstimatedRecord& e) {
  return e.method == EstimationMethod::lrm || e.response.frm.q < 1
             ? 1.0
             : confidence_radius(1.0, kLevel, e.response.frm.q);
}

std::string region_name(const EstimatedRecord& e) {
  return e.method == EstimationMethod::lrm || e.response.frm.q < 1 ? "one standard deviation (no law)"
                                                                   : "95 % confidence region";
}

Element element(const EstimatedRecord& e, int i, int j) {
  const FrmEstimate& frm = e.response.frm;
  const double factor = region_factor(e);
  Element out;
  for (int k = 0; k < frm.line_count(); ++k) {
    const auto at = static_cast<std::size_t>(k);
    if (frm.status[at] != LineStatus::ok || !frm.holds(k, j)) continue;
    const std::complex<double> g = frm.G[k](i, j);
    out.f.push_back(frm.frequency_hz[at]);
    out.magnitude.push_back(std::abs(g));
    out.db.push_back(decibel(std::abs(g)));
    out.deg.push_back(phase_deg(g));
    out.radius.push_back(factor * std::sqrt(std::max(0.0, frm.variance(k, i, j))));
    if (frm.border[at] == 0) continue;
    out.border_f.push_back(out.f.back());
    out.border_db.push_back(out.db.back());
    out.border_deg.push_back(out.deg.back());
  }
  return out;
}

void add_phase_line(plot::Panel& panel, const std::string& name, const std::vector<double>& f,
                    const std::vector<double>& deg, plot::Hue hue, plot::Dash dash) {
  const std::vector<double> smooth = plot::unwrapped(deg);
  plot::Band curve = plot::turns(f, smooth, smooth);
  panel.marks.emplace_back(plot::Line{name, std::move(curve.x), std::move(curve.low), hue, dash});
}

/// |G| ± r in dB; where the disc reaches zero the band goes 10 dB below the lowest magnitude.
void add_magnitude_band(plot::Panel& panel, const std::string& name, const Element& e) {
  double floor_db = std::numeric_limits<double>::infinity();
  for (const double db : e.db) floor_db = std::isfinite(db) ? std::min(floor_db, db - 10.0) : floor_db;
  plot::Band band{name, e.f, {}, {}, plot::Hue::blue};
  for (std::size_t k = 0; k < e.f.size(); ++k) {
    const double low = decibel(e.magnitude[k] - e.radius[k]);
    band.low.push_back(std::isfinite(low) ? std::max(low, floor_db) : floor_db);
    band.high.push_back(decibel(e.magnitude[k] + e.radius[k]));
  }
  panel.marks.emplace_back(std::move(band));
}

/// arg G ± asin(r/|G|), all phases where the disc reaches zero.
void add_phase_band(plot::Panel& panel, const std::string& name, const Element& e) {
  std::vector<double> low = plot::unwrapped(e.deg), high = low;
  for (std::size_t k = 0; k < low.size(); ++k) {
    const double half =
        e.radius[k] < e.magnitude[k] ? std::asin(e.radius[k] / e.magnitude[k]) * kDegrees : 180.0;
    low[k] -= half;
    high[k] += half;
  }
  plot::Band band = plot::turns(e.f, low, high);
  band.name = name;
  panel.marks.emplace_back(std::move(band));
}

plot::Axis frequency_axis(const FrmEstimate& frm, bool labelled) {
  const double low = frm.frequency_hz.front(), high = frm.frequency_hz.back();
  const plot::Scale scale = low > 0.0 && high > 5.0 * low ? plot::Scale::logarithmic : plot::Scale::linear;
  std::optional<plot::Range> range;
  if (high > low) range = plot::Range{low, high};
  return {labelled ? "frequency, Hz" : "", scale, range, {}};
}

plot::Axis phase_axis() {
  return {"phase, deg", plot::Scale::linear, plot::Range{-180.0, 180.0}, {-180.0, -90.0, 0.0, 90.0, 180.0}};
}

/// Reference and the envelopes about it, at the lines where it exists.
struct ReferenceCurves {
  std::vector<double> f, db, deg, upper_db, lower_db, upper_deg, lower_deg;
};

/// What is this much smaller than the reference's largest element is zero to rounding and has no magnitude to
/// compare.
constexpr double kNothing = 1e-9;

bool exists(const ReferenceResponse& reference, int k, int i, int j) {
  const double magnitude = std::abs(reference.response[k](i, j));
  return std::isfinite(magnitude) && magnitude > kNothing * reference.response[k].cwiseAbs().maxCoeff();
}

ReferenceCurves reference_curves(const EstimatedRecord& e, const ReferenceResponse& reference, int i, int j) {
  ReferenceCurves out;
  for (int k = 0; k < reference.response.count(); ++k) {
    const std::complex<double> g = reference.response[k](i, j);
    const double f = e.response.frm.frequency_hz[static_cast<std::size_t>(k)];
    if (!exists(reference, k, i, j) || !(f > 0.0)) continue;
    const UnnoticedDynamics limits = unnoticed_dynamics(f);
    out.f.push_back(f);
    out.db.push_back(decibel(std::abs(g)));
    out.deg.push_back(phase_deg(g));
    out.upper_db.push_back(out.db.back() + limits.upper_db);
    out.lower_db.push_back(out.db.back() + limits.lower_db);
    out.upper_deg.push_back(out.deg.back() + limits.upper_deg);
    out.lower_deg.push_back(out.deg.back() + limits.lower_deg);
  }
  return out;
}

const char* const kEnvelope = "MUAD envelope (constants unverified)";

void add_reference(plot::Panel& magnitude, plot::Panel& phase, const ReferenceCurves& r,
                   const std::string& name) {
  using plot::Dash, plot::Hue;
  magnitude.marks.emplace_back(plot::Line{kEnvelope, r.f, r.upper_db, Hue::green, Dash::dotted});
  magnitude.marks.emplace_back(plot::Line{kEnvelope, r.f, r.lower_db, Hue::green, Dash::dotted});
  magnitude.marks.emplace_back(plot::Line{name, r.f, r.db, Hue::orange, Dash::dashed});
  add_phase_line(phase, kEnvelope, r.f, r.upper_deg, Hue::green, Dash::dotted);
  add_phase_line(phase, kEnvelope, r.f, r.lower_deg, Hue::green, Dash::dotted);
  add_phase_line(phase, name, r.f, r.deg, Hue::orange, Dash::dashed);
}

void add_estimate(plot::Panel& magnitude, plot::Panel& phase, const EstimatedRecord& e, const Element& g) {
  using plot::Dash, plot::Hue;
  add_magnitude_band(magnitude, region_name(e), g);
  add_phase_band(phase, region_name(e), g);
  magnitude.marks.emplace_back(plot::Line{"estimate", g.f, g.db, Hue::blue, Dash::solid});
  add_phase_line(phase, "estimate", g.f, g.deg, Hue::blue, Dash::solid);
  if (g.f.size() <= kMostDots) {
    magnitude.marks.emplace_back(plot::Points{"", g.f, g.db, Hue::blue, true});
    phase.marks.emplace_back(plot::Points{"", g.f, g.deg, Hue::blue, true});
  }
  magnitude.marks.emplace_back(plot::Points{"border line", g.border_f, g.border_db, Hue::red, false});
  phase.marks.emplace_back(plot::Points{"border line", g.border_f, g.border_deg, Hue::red, false});
}

std::string element_title(const EstimatedRecord& e, int i, int j) {
  return channel_names(e.record, e.record.output)[static_cast<std::size_t>(i)] + " / " +
         channel_names(e.record, e.record.input)[static_cast<std::size_t>(j)];
}

/// An output's two rows of panels, filled by `fill(i, j, upper, lower)`.
template <typename Fill>
plot::Figure element_grid(const EstimatedRecord& e, const Fill& fill) {
  const FrmEstimate& frm = e.response.frm;
  plot::Figure figure;
  figure.columns = frm.n_in;
  figure.panel_width = frm.n_in == 1 ? 640.0 : frm.n_in == 2 ? 460.0 : 340.0;
  for (int i = 0; i < frm.n_out; ++i) {
    std::vector<plot::Panel> upper, lower;
    for (int j = 0; j < frm.n_in; ++j) {
      upper.emplace_back().x = frequency_axis(frm, false);
      lower.emplace_back().x = frequency_axis(frm, i + 1 == frm.n_out);
      fill(i, j, upper.back(), lower.back());
      if (j > 0) upper.back().y.label = lower.back().y.label = "";
    }
    figure.panels.insert(figure.panels.end(), upper.begin(), upper.end());
    figure.panels.insert(figure.panels.end(), lower.begin(), lower.end());
  }
  return figure;
}

}  // namespace

plot::Figure response_figure(const EstimatedRecord& e, const std::optional<ReferenceResponse>& reference) {
  plot::Figure figure = element_grid(e, [&](int i, int j, plot::Panel& magnitude, plot::Panel& phase) {
    magnitude.title = element_title(e, i, j);
    magnitude.y.label = "magnitude, dB";
    phase.y = phase_axis();
    if (reference) add_reference(magnitude, phase, reference_curves(e, *reference, i, j), reference->name);
    add_estimate(magnitude, phase, e, element(e, i, j));
  });
  figure.title = "Frequency response";
  figure.note = estimate_title(e) + ", q = " + std::to_string(e.response.frm.q);
  return figure;
}

plot::Figure error_figure(const EstimatedRecord& e, const ReferenceResponse& reference) {
  const FrmEstimate& frm = e.response.frm;
  plot::Figure figure = element_grid(e, [&](int i, int j, plot::Panel& magnitude, plot::Panel& phase) {
    using plot::Dash, plot::Hue;
    std::array<std::vector<double>, 4> limits;  // upper, lower in dB, then deg
    std::vector<double> f, db, deg;
    std::vector<ResponseError> errors;
    int outside = 0;
    for (int k = 0; k < frm.line_count(); ++k) {
      const auto at = static_cast<std::size_t>(k);
      if (frm.status[at] != LineStatus::ok || !frm.holds(k, j) || !exists(reference, k, i, j) ||
          !(frm.frequency_hz[at] > 0.0)) {
        continue;
      }
      const Result<ResponseError> error = response_error(frm.G[k](i, j), reference.response[k](i, j));
      if (!error) continue;
      const UnnoticedDynamics limit = unnoticed_dynamics(frm.frequency_hz[at]);
      f.push_back(frm.frequency_hz[at]);
      db.push_back(error->magnitude_db);
      deg.push_back(error->phase_deg);
      limits[0].push_back(limit.upper_db);
      limits[1].push_back(limit.lower_db);
      limits[2].push_back(limit.upper_deg);
      limits[3].push_back(limit.lower_deg);
      errors.push_back(*error);
      outside += unnoticed(*error, f.back()) ? 0 : 1;
    }
    magnitude.title = element_title(e, i, j);
    if (errors.empty()) {
      magnitude.title += ": the reference is zero";
    } else {
      magnitude.title += ": cost " + significant(response_cost(errors), 3) + ", " + std::to_string(outside) +
                         " of " + std::to_string(f.size()) + " outside";
    }
    magnitude.y.label = "error, dB";
    phase.y.label = "error, deg";
    for (const std::size_t k : {0U, 1U}) {
      magnitude.marks.emplace_back(plot::Line{kEnvelope, f, limits[k], Hue::green, Dash::dotted});
      phase.marks.emplace_back(plot::Line{kEnvelope, f, limits[2 + k], Hue::green, Dash::dotted});
    }
    for (auto [panel, values] : {std::pair(&magnitude, &db), std::pair(&phase, &deg)}) {
      panel->marks.emplace_back(plot::Rule{"", 0.0, false, Hue::grey, Dash::solid});
      panel->marks.emplace_back(
          plot::Line{"estimate over " + reference.name, f, *values, Hue::blue, Dash::solid});
      if (f.size() <= kMostDots) panel->marks.emplace_back(plot::Points{"", f, *values, Hue::blue, true});
    }
  });
  figure.title = "Error response function";
  figure.note = "estimate over " + reference.name +
                "; cost function (3.8): below 100 acceptable, below 50 hardly to be told from flight data";
  return figure;
}

}  // namespace fatmc::cli
