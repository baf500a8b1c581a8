#include "coordinator/cli/response_diagnosis.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <nlohmann/json.hpp>

#include "coordinator/cli/response_model.h"
#include "coordinator/report/html_page.h"
#include "core/base/text.h"
#include "core/discrepancy/residual_response.h"

namespace fatmc::cli {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kCoherentExcess = 2.0;  // error over its incoherent part, from which on something is missing
constexpr const char* kSeparatedBy = "a record in which the inputs have other phases to each other";
constexpr double kIncoherent = 0.2;  // of an output's energy: more than this is no answer of a linear model

/// Energies of one record: sums over outputs of error over the incoherent part.
struct Energies {
  double before = 0.0, after = 0.0;
  int outputs = 0;
};

Json gap_json(const Energies& e) {
  const double n = std::max(1, e.outputs);
  return {{"before", e.before / n}, {"after", e.after / n}, {"floor", 1.0}};
}

/// The model's response at its own frequencies with the elements added.
std::string repaired_csv(const ModelledSpectra& s, const ResidualResponse& fit) {
  std::string out = "line,frequency_hz,output,input,re,im\n";
  const auto outputs = static_cast<Eigen::Index>(s.outputs.size());
  const ResponseTable& model = s.response;
  for (std::size_t k = 0; k < model.frequency_hz.size(); ++k) {
    const double f = model.frequency_hz[k];
    // The correction is that of the nearest bin; outside of the band of the fit there is none.
    const auto above =
        std::lower_bound(fit.frequency_hz.begin(), fit.frequency_hz.end(), f) - fit.frequency_hz.begin();
    const bool inside = f >= fit.frequency_hz.front() && f <= fit.frequency_hz.back();
    for (std::size_t i = 0; i < s.outputs.size(); ++i) {
      for (std::size_t j = 0; j < s.inputs.size(); ++j) {
        const auto row = static_cast<Eigen::Index>(i), column = static_cast<Eigen::Index>(j);
        const auto a =
            std::find(model.outputs.begin(), model.outputs.end(), s.outputs[i]) - model.outputs.begin();
        const auto b =
            std::find(model.inputs.begin(), model.inputs.end(), s.inputs[j]) - model.inputs.begin();
        std::complex<double> g = s.absent(row, column) ? 0.0 : model.response[static_cast<int>(k)](a, b);
        if (inside) g += fit.response(above, column * outputs + row);
        out += std::to_string(k) + "," + shortest(f) + "," + s.outputs[i] + "," + s.inputs[j] + "," +
               shortest(g.real()) + "," + shortest(g.imag()) + "\n";
      }
    }
  }
  return out;
}

}  // namespace

Result<ResponseDiagnosisFiles> diagnose_response(const std::string& path,
                                                 const std::vector<std::string>& records,
                                                 const std::vector<std::string>& holdout) {
  const auto model = read_response_model(path);
  if (!model) return fail(model.error());
  if (records.size() != 1)
    return fail(Error{"", 0, "--record", "give one record to a model of this kind, others as --holdout"});
  if (!model->repairable() && !holdout.empty())
    return fail(Error{path, 0, "--holdout", "a recorded output says nothing about another record"});
  const auto training = modelled_spectra(records.front(), *model);
  if (!training) return fail(training.error());
  const ResidualOptions options;
  auto fit = fit_residual_response(training->frequency_hz, training->error, training->output, training->input,
                                   options);
  if (!fit) return fail(Error{records.front(), 0, "", fit.error().message});

  const auto outputs = static_cast<Eigen::Index>(training->outputs.size());
  Energies own, held;
  std::vector<std::string> incoherent;
  for (Eigen::Index i = 0; i < outputs; ++i) {
    const double floor = std::max(fit->floor[i], 1e-300);
    own.before += fit->before[i] / floor;
    own.after += fit->after[i] / floor;
    ++own.outputs;
    if (fit->floor[i] > kIncoherent * fit->output_energy[i])
      incoherent.push_back(training->outputs[static_cast<std::size_t>(i)]);
  }
  for (const std::string& file : holdout) {
    const auto other = modelled_spectra(file, *model);
    if (!other) return fail(other.error());
    auto floor =
        fit_residual_response(other->frequency_hz, other->error, other->output, other->input, options);
    if (!floor) return fail(Error{file, 0, "", floor.error().message});
    const Eigen::MatrixXcd left =
        apply_residual_response(*fit, other->frequency_hz, other->error, other->input);
    for (Eigen::Index i = 0; i < outputs; ++i) {
      held.before += other->error.col(i).squaredNorm() / std::max(floor->floor[i], 1e-300);
      held.after += left.col(i).squaredNorm() / std::max(floor->floor[i], 1e-300);
      ++held.outputs;
    }
  }

  // Inputs that are nearly copies of each other within a window leave the error explained by all of them and by none alone, or
  // by large responses that cancel: such elements make things worse where they are applied.
  const bool worse = own.after > own.before || held.after > held.before;
  std::vector<std::string> members;
  for (Eigen::Index i = 0; i < outputs; ++i) {
    const bool found = !worse && std::any_of(fit->elements.begin(), fit->elements.end(),
                                             [&](const auto& e) { return e.first == i; });
    if (found || fit->before[i] < kCoherentExcess * fit->floor[i]) continue;
    const std::string out = training->outputs[static_cast<std::size_t>(i)];
    for (std::size_t j = 0; j < training->inputs.size(); ++j) {
      const bool absent = training->absent(i, static_cast<Eigen::Index>(j));
      members.push_back((absent ? "cross_coupling:output=" : "element_error:output=") + out +
                        ",input=" + training->inputs[j]);
    }
  }
  if (worse) {
    fit->elements.clear();
    fit->response.setZero();
    own.after = own.before;
    held.after = held.before;
  }
  const bool nothing = fit->elements.empty() && incoherent.empty() && members.empty();
  const bool repaired = model->repairable() && !fit->elements.empty();
  const std::string verdict = nothing                                       ? "none"
                              : !incoherent.empty() || !model->repairable() ? "unknown"
                              : !members.empty()                            ? "class"
                                                                            : "named";
  Json json;
  json["verdict"] = verdict;
  json["effects"] = Json::array();
  std::string list,
      patch = "kind = \"patch\"\nparent = \"" + path + "\"\nparent_sha256 = \"" + model->hash + "\"\n";
  for (std::size_t e = 0; e < fit->elements.size() && model->repairable(); ++e) {
    const auto [i, j] = fit->elements[e];
    const std::string id = training->absent(i, j) ? "cross_coupling" : "element_error";
    const std::string out = training->outputs[static_cast<std::size_t>(i)],
                      in = training->inputs[static_cast<std::size_t>(j)];
    json["effects"].push_back({{"id", id},
                               {"name", id + ":output=" + out + ",input=" + in},
                               {"parameters", Json::array({{{"name", "explained"},
                                                            {"value", fit->explained[e]},
                                                            {"low", nullptr},
                                                            {"high", nullptr},
                                                            {"unit", "share of the output's error"}}})}});
    list += "  " + id + ":output=" + out + ",input=" + in + " explains " +
            significant(100.0 * fit->explained[e], 3) + " % of the error in " + out + "\n";
    patch += "\n[[effect]]\nid = \"" + id + "\"\noutput = \"" + out + "\"\ninput = \"" + in +
             "\"  # its response: frm.csv\n";
  }
  json["class"] = members;
  json["separate_by"] = members.empty() ? "" : kSeparatedBy;
  if (!members.empty())
    list += "  these records cannot separate: " + join(members) + "\n  separated by: " + kSeparatedBy + "\n";
  json["where"] = Json::array();
  std::vector<std::vector<std::string>> rows;
  for (const ResidualPlace& p : fit->places) {
    const std::string out = training->outputs[static_cast<std::size_t>(p.output)],
                      in = training->inputs[static_cast<std::size_t>(p.input)];
    const double decibel = 10.0 * std::log10(std::max(1e-6, 1.0 - p.share));
    json["where"].push_back({{"output", out},
                             {"input", in},
                             {"low_hz", p.low_hz},
                             {"high_hz", p.high_hz},
                             {"decibel", decibel},
                             {"sigma", p.sigma}});
    rows.push_back({html::text(out), html::text(in), html::text(significant(p.low_hz, 4)),
                    html::text(significant(p.high_hz, 4)), html::text(significant(100.0 * p.share, 3)),
                    html::text(significant(p.sigma, 3))});
  }
  json["gap"] = {{"training", gap_json(own)}, {"holdout", holdout.empty() ? Json(nullptr) : gap_json(held)}};
  json["incoherent"] = Json::array();
  std::string incoherence;
  for (Eigen::Index i = 0; i < outputs; ++i) {
    const double share = fit->floor[i] / fit->output_energy[i];
    json["incoherent"].push_back({{"output", training->outputs[static_cast<std::size_t>(i)]},
                                  {"share", share},
                                  {"unknown", share > kIncoherent}});
    incoherence += "  " + training->outputs[static_cast<std::size_t>(i)] + ": " +
                   significant(100.0 * share, 3) + " % of its energy is no response to the inputs" +
                   (share > kIncoherent ? ": unknown" : "") + "\n";
  }
  json["notes"] = training->notes;
  const std::string gap = "gap per output and bin, floor 1: training " +
                          significant(own.before / own.outputs, 4) + " -> " +
                          significant(own.after / own.outputs, 4) +
                          (holdout.empty() ? std::string("; nothing was held out\n")
                                           : ", held out " + significant(held.before / held.outputs, 4) +
                                                 " -> " + significant(held.after / held.outputs, 4) + "\n");
  ResponseDiagnosisFiles files;
  files.summary = "verdict: " + verdict + "\n" + list + gap + incoherence;
  for (const std::string& note : training->notes) files.summary += "note: " + note + "\n";
  files.files.emplace_back("diagnosis.json", json.dump(2) + "\n");
  files.files.emplace_back("patch.toml", patch);
  if (repaired) {
    files.files.emplace_back("frm.csv", repaired_csv(*training, *fit));
    files.files.emplace_back("model.toml", "# fatmc patch of parent " + model->hash +
                                               "\nkind = \"frf\"\nresponse = \"frm.csv\"\n");
  }
  std::string body = "<header><h1>Diagnosis of " + html::text(path) + "</h1></header>\n<main>\n<pre>" +
                     html::text(files.summary) + "</pre>\n<h2>Where</h2>\n";
  body += html::table({{"output"},
                       {"input"},
                       {"from Hz", true},
                       {"to Hz", true},
                       {"explains % of the error there", true},
                       {"sigma", true}},
                      rows) +
          "</main>\n";
  files.files.emplace_back("report.html", html::page("Diagnosis of " + path, body));
  return files;
}

}  // namespace fatmc::cli
