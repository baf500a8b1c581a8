#include "coordinator/cli/diagnosis_report.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "coordinator/report/html_page.h"
#include "core/base/text.h"
#include "core/discrepancy/effect_knowledge.h"

namespace fatmc::cli {
namespace {

constexpr std::array<const char*, 3> kOutputs = {"p", "q", "r"}, kInputs = {"xi_c", "eta_c", "zeta_c"};
constexpr double kDegrees = 57.29577951308232;

std::string paragraph(const std::string& text) { return "<p>" + html::text(text) + "</p>\n"; }
std::string number(double x, int digits = 4) { return html::text(significant(x, digits)); }

std::string headline(const DiagnosisPage& page) {
  const Diagnosis& d = page.diagnosis;
  std::vector<std::string> names;
  for (const FoundEffect& f : page.earlier) names.push_back(f.effect.name());
  for (const FoundEffect& f : d.effects) names.push_back(f.effect.name());
  switch (d.verdict) {
    case Verdict::none:
      return names.empty() ? "Records and model agree: nothing is missing that these records could show."
                           : "With " + join(names) + " records and model agree.";
    case Verdict::named:
      return "Missing: " + join(names) + ".";
    case Verdict::effect_class: {
      std::vector<std::string> members;
      for (const Effect& m : d.members) members.push_back(m.text());
      return "Missing is one of: " + join(members) +
             ". These records cannot separate them; this would: " + d.separate_by + ".";
    }
    case Verdict::unknown:
      return names.empty() ? "Something is missing that no effect of the library explains."
                           : "Something is missing; " + join(names) +
                                 " explains part of it, the rest no effect of the library does.";
  }
  return "";
}

std::string effects_table(const DiagnosisPage& page) {
  std::vector<std::vector<std::string>> rows;
  std::vector<FoundEffect> all = page.earlier;
  all.insert(all.end(), page.diagnosis.effects.begin(), page.diagnosis.effects.end());
  for (const FoundEffect& f : all) {
    for (const ParameterEstimate& p : f.parameters) {
      rows.push_back({html::text(f.effect.kind().title), html::text(f.effect.name()), html::text(p.name),
                      number(p.value), number(p.low), number(p.high),
                      html::text(p.unit == "1" ? "" : p.unit)});
    }
  }
  if (rows.empty()) return "";
  std::string out =
      "<h2>What is missing</h2>\n" +
      html::table(
          {{"effect"}, {"id"}, {"parameter"}, {"value", true}, {"95 % from", true}, {"to", true}, {"unit"}},
          rows);
  for (const FoundEffect& f : all) {
    const EffectKnowledge* known = find_knowledge(f.effect.id);
    if (known == nullptr) continue;
    std::vector<std::string> others(known->confusable.begin(), known->confusable.end());
    out += paragraph(f.effect.id + ": " + std::string(f.effect.kind().physics) +
                     " Signature: " + std::string(known->signature) + ". Easily confused with " +
                     join(others) + "; separated by " + std::string(known->separated_by) + ".");
  }
  return out;
}

std::string gap_table(const DiagnosisPage& page) {
  const Diagnosis& d = page.diagnosis;
  const auto row = [](const std::string& what, const std::string& quantity, double before, double after,
                      double floor) {
    return std::vector<std::string>{html::text(what), html::text(quantity), number(before), number(after),
                                    number(floor)};
  };
  std::vector<std::vector<std::string>> rows = {
      row("training", "whitened chi-square per feature", d.training.before, d.training.after,
          d.training.floor),
      row("held out", "whitened chi-square per feature", d.holdout.before, d.holdout.after, d.holdout.floor)};
  for (const MeasuredGap& g : page.gaps) {
    const std::string what = (g.holdout ? "held out: " : "") + g.record;
    rows.push_back(row(what, "cost function", g.before.cost, g.after.cost, g.floor.cost));
    rows.push_back(row(what, "lines outside MUAD, %", 100.0 * g.before.muad_share, 100.0 * g.after.muad_share,
                       100.0 * g.floor.muad_share));
    rows.push_back(row(what, "Theil", g.before.theil, g.after.theil, g.floor.theil));
    rows.push_back(
        row(what, "index of agreement d1", g.before.agreement, g.after.agreement, g.floor.agreement));
  }
  return "<h2>The gap</h2>\n" +
         html::table({{"data"}, {"measure"}, {"before", true}, {"after", true}, {"noise floor", true}},
                     rows) +
         paragraph(
             std::string("Held out: ") +
             (d.holdout_lines ? "every fifth line, since no further record was given." : "whole records.") +
             " The floor of the measures is what a flight of the patched model itself has against its mean. "
             "MUAD limits are "
             "quoted from MIL-HDBK-1797 from memory (unverified).");
}

plot::Figure map_figure(const std::vector<MapEntry>& map) {
  plot::Figure out;
  out.title = "Where record and model disagree";
  out.note = "1 % of the model's own flights pass the limit anywhere on the map";
  out.columns = 3;
  out.panel_width = 300.0;
  out.panel_height = 150.0;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      plot::Panel panel;
      panel.title =
          std::string(kOutputs[static_cast<std::size_t>(i)]) + " / " + kInputs[static_cast<std::size_t>(j)];
      panel.x.label = "Hz";
      panel.x.scale = plot::Scale::logarithmic;
      panel.y.label = "sigma";
      plot::Line line{"record", {}, {}, plot::Hue::orange, plot::Dash::solid};
      plot::Line limit{"limit of chance", {}, {}, plot::Hue::grey, plot::Dash::dashed};
      for (const MapEntry& e : map) {
        if (e.cell.output != i || e.cell.input != j) continue;
        line.x.insert(line.x.end(), {e.low_hz, e.high_hz});
        line.y.insert(line.y.end(), {e.sigma, e.sigma});
        limit.y.insert(limit.y.end(), {e.limit, e.limit});
      }
      limit.x = line.x;
      panel.marks.emplace_back(std::move(limit));
      panel.marks.emplace_back(std::move(line));
      out.panels.push_back(std::move(panel));
    }
  }
  return out;
}

plot::Figure overlay_figure(const ResponseOverlay& o, bool phase) {
  plot::Figure out;
  out.title = phase ? "Phase, deg" : "Magnitude, dB";
  out.columns = 3;
  out.panel_width = 300.0;
  out.panel_height = 170.0;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      plot::Panel panel;
      panel.title =
          std::string(kOutputs[static_cast<std::size_t>(i)]) + " / " + kInputs[static_cast<std::size_t>(j)];
      panel.x.label = "Hz";
      panel.x.scale = plot::Scale::logarithmic;
      plot::Points measured{"record", {}, {}, plot::Hue::blue, true};
      plot::Line before{"model before", {}, {}, plot::Hue::orange, plot::Dash::dashed},
          after{"model after", {}, {}, plot::Hue::green, plot::Dash::solid};
      for (std::size_t k = 0; k < o.frequency_hz.size(); ++k) {
        const auto at = static_cast<Eigen::Index>(9 * k) + 3 * j + i;
        const std::complex<double> ref = o.measured[at];
        const auto value = [&](std::complex<double> g) {
          return phase ? kDegrees * (std::arg(ref) + std::arg(g * std::conj(ref)))
                       : 20.0 * std::log10(std::abs(g));
        };
        measured.x.push_back(o.frequency_hz[k]);
        measured.y.push_back(value(ref));
        before.x.push_back(o.frequency_hz[k]);
        before.y.push_back(value(o.before[at]));
        after.x.push_back(o.frequency_hz[k]);
        after.y.push_back(value(o.after[at]));
      }
      panel.marks.emplace_back(std::move(measured));
      panel.marks.emplace_back(std::move(before));
      panel.marks.emplace_back(std::move(after));
      out.panels.push_back(std::move(panel));
    }
  }
  return out;
}

std::string places_table(const DiagnosisPage& page) {
  std::vector<std::vector<std::string>> rows;
  for (const Place& p : page.where) {
    rows.push_back({html::text(p.output), html::text(p.input), number(p.low_hz), number(p.high_hz),
                    number(p.decibel, 3), number(p.degrees, 3), number(p.sigma, 3)});
  }
  if (rows.empty()) return paragraph("No element, band, mean or spectrum differs by more than chance.");
  return html::table({{"output"},
                      {"input"},
                      {"from Hz", true},
                      {"to Hz", true},
                      {"dB", true},
                      {"deg", true},
                      {"sigma", true}},
                     rows);
}

}  // namespace

std::string diagnosis_html(const DiagnosisPage& page, const std::vector<ResponseOverlay>& overlays,
                           const std::vector<MapEntry>& map) {
  std::string body = "<header><h1>Diagnosis of " + html::text(page.model->model.aircraft.name) + "</h1>\n" +
                     paragraph(headline(page)) + "</header>\n<main>\n";
  const Evidence& e = page.diagnosis.evidence;
  body += paragraph("Largest likelihood ratio of a signature " + significant(e.scan, 4) + " (threshold " +
                    significant(page.thresholds.scan, 4) + "), energy " + significant(e.energy, 5) + " (" +
                    significant(page.thresholds.energy, 5) + "), local " + significant(e.local, 4) + " (" +
                    significant(page.thresholds.local, 4) +
                    "); left with the effects: " + significant(e.scan_left, 4) + ", " +
                    significant(e.energy_left, 5) + ", " + significant(e.local_left, 4) + ".");
  for (const std::string& note : page.diagnosis.notes) body += paragraph(note);
  body += effects_table(page) + gap_table(page) + "<h2>Where</h2>\n" +
          html::figure(map_figure(map), "map", "Map",
                       "Rms deviation of each element and band of the frequency response matrix, "
                       "of the first record, in standard deviations of flights of the model.") +
          places_table(page);
  int n = 0;
  for (const ResponseOverlay& o : overlays) {
    const std::string id = "overlay-" + std::to_string(++n);
    body += "<h2>" + html::text((o.holdout ? "Held out: " : "") + o.record) + "</h2>\n" +
            html::figure(overlay_figure(o, false), id, "Magnitude",
                         "Estimates of the record and means of the model's flights on the same reference.") +
            html::figure(overlay_figure(o, true), id + "-phase", "Phase", "Likewise.");
  }
  body += "</main>\n";
  return html::page("Diagnosis of " + page.model->model.aircraft.name, body);
}

}  // namespace fatmc::cli
