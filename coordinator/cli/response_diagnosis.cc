#include "coordinator/cli/response_diagnosis.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "campaigns/base/decoder.h"
#include "campaigns/base/trial_row.h"
#include "coordinator/input/record_file.h"
#include "coordinator/input/response_file.h"
#include "coordinator/input/toml_file.h"
#include "coordinator/report/html_page.h"
#include "core/base/text.h"
#include "core/discrepancy/residual_response.h"
#include "core/record/column_file.h"
#include "core/signal/dft.h"

namespace fatmc::cli {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr double kCoherentExcess = 2.0;  // error over its incoherent part, from which on something is missing
constexpr const char* kSeparatedBy = "a record in which the inputs have other phases to each other";
constexpr double kIncoherent = 0.2;  // of an output's energy: more than this is no answer of a linear model

struct ResponseModel {
  std::string path, hash;
  bool recorded = false, diagonal = false;
  ResponseTable response;
  Columns series;
  std::vector<std::string> columns;
  std::vector<double> band_hz;
};

Result<ResponseModel> read_model(const std::string& path) {
  auto tree = read_toml(path);
  if (!tree) return fail(tree.error());
  ResponseModel out;
  out.path = path;
  Decoder top(*tree, "");
  out.recorded = top.choice("kind", {"frf", "recorded_output"}) == "recorded_output";
  const std::string file = top.text(out.recorded ? "data" : "response");
  if (out.recorded) {
    out.columns = top.texts("output");
  } else {
    out.diagonal = top.choice("elements", {"all", "diagonal"}, "all") == "diagonal";
  }
  if (top.has("band_hz")) out.band_hz = top.reals("band_hz", 2, {.low = 0.0, .high = 1e6});
  if (!top.error() && !out.band_hz.empty() && out.band_hz[1] <= out.band_hz[0])
    top.reject("band_hz", "write a lower and a higher frequency");
  if (Status status = top.finish(); !status) return fail(status.error());
  const std::string data = (fs::path(path).parent_path() / file).string();
  if (out.recorded) {
    auto columns = read_columns(data);
    if (!columns) return fail(columns.error());
    out.series = std::move(*columns);
  } else {
    auto table = read_response_table(data);
    if (!table) return fail(table.error());
    out.response = std::move(*table);
  }
  std::ifstream in(path, std::ios::binary);
  std::stringstream text;
  text << in.rdbuf();
  out.hash = hex(sha256(text.str()));
  return out;
}

/// Spectra of one record in the band, and what the model makes of them.
struct Spectra {
  std::vector<double> frequency_hz;
  Eigen::MatrixXcd input, output, error;
  std::vector<std::string> inputs, outputs;
};

Eigen::MatrixXcd transform(const Eigen::MatrixXd& samples) {
  const RealDft dft(static_cast<int>(samples.rows()));
  Eigen::MatrixXcd out(samples.rows() / 2 + 1, samples.cols());
  for (Eigen::Index c = 0; c < samples.cols(); ++c) {
    const Eigen::VectorXd x = samples.col(c).array() - samples.col(c).mean();
    dft.transform({x.data(), static_cast<std::size_t>(x.size())},
                  {out.col(c).data(), static_cast<std::size_t>(out.rows())});
  }
  return out;
}

/// The frequency below which 99 % of the inputs' energy lies.
double input_band(const Eigen::MatrixXcd& input, double bin_hz) {
  const double all = input.squaredNorm();
  double sum = 0.0;
  Eigen::Index m = 0;
  while (m < input.rows() - 1 && sum < 0.99 * all) sum += input.row(m++).squaredNorm();
  return static_cast<double>(m) * bin_hz;
}

std::complex<double> interpolated(const ResponseTable& table, double f, Eigen::Index i, Eigen::Index j) {
  const auto& grid = table.frequency_hz;
  const auto above = std::lower_bound(grid.begin(), grid.end(), f) - grid.begin();
  const int hi = static_cast<int>(
                std::min<std::ptrdiff_t>(above, static_cast<std::ptrdiff_t>(grid.size()) - 1)),
            lo = std::max(0, hi - 1);
  const double span = grid[static_cast<std::size_t>(hi)] - grid[static_cast<std::size_t>(lo)];
  const double share =
      span > 0.0 ? std::clamp((f - grid[static_cast<std::size_t>(lo)]) / span, 0.0, 1.0) : 1.0;
  return (1.0 - share) * table.response[lo](i, j) + share * table.response[hi](i, j);
}

Result<Spectra> spectra_of(const std::string& path, const ResponseModel& model) {
  auto record = read_record(path);
  if (!record) return fail(record.error());
  Spectra out;
  for (const int c : record->input) out.inputs.push_back(record->names[static_cast<std::size_t>(c)]);
  for (const int c : record->output) out.outputs.push_back(record->names[static_cast<std::size_t>(c)]);
  const Eigen::MatrixXcd u = transform(record->channels(record->input)),
                         y = transform(record->channels(record->output));
  const double bin_hz = record->rate_hz / record->sample_count();
  double low = bin_hz, high = input_band(u, bin_hz);
  if (!model.recorded) {
    low = std::max(low, model.response.frequency_hz.front());
    high = std::min(high, model.response.frequency_hz.back());
  }
  if (!model.band_hz.empty()) {
    low = std::max(low, model.band_hz[0]);
    high = model.band_hz[1];
  }
  const auto first = static_cast<Eigen::Index>(std::ceil(low / bin_hz - 1e-9));
  const auto last =
      std::min<Eigen::Index>(static_cast<Eigen::Index>(std::floor(high / bin_hz + 1e-9)), u.rows() - 1);
  if (last <= first) return fail(Error{path, 0, "band_hz", "holds no bins of the record and the model"});
  for (Eigen::Index m = first; m <= last; ++m) out.frequency_hz.push_back(static_cast<double>(m) * bin_hz);
  out.input = u.middleRows(first, last - first + 1);
  out.output = y.middleRows(first, last - first + 1);
  Eigen::MatrixXcd modelled = Eigen::MatrixXcd::Zero(out.output.rows(), out.output.cols());
  if (model.recorded) {
    if (model.columns.size() != out.outputs.size()) {
      return fail(Error{model.path, 0, "output",
                        "names " + std::to_string(model.columns.size()) + " columns, the record has " +
                            std::to_string(out.outputs.size()) + " outputs"});
    }
    if (model.series.values.rows() != record->sample_count()) {
      return fail(Error{model.path, 0, "data",
                        "has " + std::to_string(model.series.values.rows()) + " rows, the record " + path +
                            " has " + std::to_string(record->sample_count())});
    }
    Eigen::MatrixXd series(model.series.values.rows(), out.output.cols());
    for (std::size_t i = 0; i < model.columns.size(); ++i) {
      const auto at = std::find(model.series.names.begin(), model.series.names.end(), model.columns[i]);
      if (at == model.series.names.end())
        return fail(Error{model.path, 0, "output",
                          "names \"" + model.columns[i] + "\", the data have " + join(model.series.names)});
      series.col(static_cast<Eigen::Index>(i)) = model.series.values.col(at - model.series.names.begin());
    }
    modelled = transform(series).middleRows(first, last - first + 1);
  } else {
    const auto place = [](const std::vector<std::string>& names, const std::string& name) {
      return std::find(names.begin(), names.end(), name) - names.begin();
    };
    for (std::size_t i = 0; i < out.outputs.size(); ++i) {
      for (std::size_t j = 0; j < out.inputs.size(); ++j) {
        const auto a = place(model.response.outputs, out.outputs[i]),
                   b = place(model.response.inputs, out.inputs[j]);
        if (a == static_cast<std::ptrdiff_t>(model.response.outputs.size()) ||
            b == static_cast<std::ptrdiff_t>(model.response.inputs.size())) {
          return fail(
              Error{model.path, 0, "response",
                    "has no element " + out.outputs[i] + "/" + out.inputs[j] + " of the record " + path});
        }
        if (model.diagonal && i != j) continue;
        for (Eigen::Index m = 0; m < modelled.rows(); ++m) {
          modelled(m, static_cast<Eigen::Index>(i)) +=
              interpolated(model.response, out.frequency_hz[static_cast<std::size_t>(m)], a, b) *
              out.input(m, static_cast<Eigen::Index>(j));
        }
      }
    }
  }
  out.error = out.output - modelled;
  return out;
}

/// Energies of one record: sums over outputs of error over the incoherent part.
struct Energies {
  double before = 0.0, after = 0.0;
  int outputs = 0;
};

Json gap_json(const Energies& e) {
  const double n = std::max(1, e.outputs);
  return {{"before", e.before / n}, {"after", e.after / n}, {"floor", 1.0}};
}

/// Added element of the response at the model's own frequencies.
std::string repaired_csv(const ResponseModel& model, const Spectra& s, const ResidualResponse& fit) {
  std::string out = "line,frequency_hz,output,input,re,im\n";
  const auto outputs = static_cast<Eigen::Index>(s.outputs.size());
  for (std::size_t k = 0; k < model.response.frequency_hz.size(); ++k) {
    const double f = model.response.frequency_hz[k];
    // The correction is that of the nearest bin; outside of the band of the fit there is none.
    const auto above =
        std::lower_bound(fit.frequency_hz.begin(), fit.frequency_hz.end(), f) - fit.frequency_hz.begin();
    const bool inside = f >= fit.frequency_hz.front() && f <= fit.frequency_hz.back();
    for (std::size_t i = 0; i < s.outputs.size(); ++i) {
      for (std::size_t j = 0; j < s.inputs.size(); ++j) {
        const auto a = std::find(model.response.outputs.begin(), model.response.outputs.end(), s.outputs[i]) -
                       model.response.outputs.begin();
        const auto b = std::find(model.response.inputs.begin(), model.response.inputs.end(), s.inputs[j]) -
                       model.response.inputs.begin();
        std::complex<double> g =
            model.diagonal && i != j ? 0.0 : model.response.response[static_cast<int>(k)](a, b);
        if (inside)
          g += fit.response(above, static_cast<Eigen::Index>(j) * outputs + static_cast<Eigen::Index>(i));
        out += std::to_string(k) + "," + shortest(f) + "," + s.outputs[i] + "," + s.inputs[j] + "," +
               shortest(g.real()) + "," + shortest(g.imag()) + "\n";
      }
    }
  }
  return out;
}

}  // namespace

std::string response_kind(const std::string& model) {
  const auto tree = read_toml(model);
  if (!tree) return "";
  const Tree* kind = tree->find("kind");
  const auto* text = kind != nullptr ? std::get_if<std::string>(&kind->value) : nullptr;
  return text != nullptr && (*text == "frf" || *text == "recorded_output") ? *text : "";
}

Result<ResponseDiagnosisFiles> diagnose_response(const std::string& path,
                                                 const std::vector<std::string>& records,
                                                 const std::vector<std::string>& holdout) {
  auto model = read_model(path);
  if (!model) return fail(model.error());
  if (records.size() != 1)
    return fail(Error{"", 0, "--record", "give one record to a model of this kind, others as --holdout"});
  if (model->recorded && !holdout.empty())
    return fail(Error{path, 0, "--holdout", "a recorded output says nothing about another record"});
  auto training = spectra_of(records.front(), *model);
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
    auto other = spectra_of(file, *model);
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
      const bool absent = model->diagonal && static_cast<std::size_t>(i) != j;
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
  const bool repaired = !model->recorded && !fit->elements.empty();
  const std::string verdict = nothing                                  ? "none"
                              : !incoherent.empty() || model->recorded ? "unknown"
                              : !members.empty()                       ? "class"
                                                                       : "named";
  Json json;
  json["verdict"] = verdict;
  json["effects"] = Json::array();
  std::string list,
      patch = "kind = \"patch\"\nparent = \"" + path + "\"\nparent_sha256 = \"" + model->hash + "\"\n";
  for (std::size_t e = 0; e < fit->elements.size() && !model->recorded; ++e) {
    const auto [i, j] = fit->elements[e];
    const std::string id = model->diagonal && i != j ? "cross_coupling" : "element_error";
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
  const std::string gap = "gap per output and bin, floor 1: training " +
                          significant(own.before / own.outputs, 4) + " -> " +
                          significant(own.after / own.outputs, 4) +
                          (holdout.empty() ? std::string("; nothing was held out\n")
                                           : ", held out " + significant(held.before / held.outputs, 4) +
                                                 " -> " + significant(held.after / held.outputs, 4) + "\n");
  ResponseDiagnosisFiles files;
  files.summary = "verdict: " + verdict + "\n" + list + gap + incoherence;
  files.files.emplace_back("diagnosis.json", json.dump(2) + "\n");
  files.files.emplace_back("patch.toml", patch);
  if (repaired) {
    files.files.emplace_back("frm.csv", repaired_csv(*model, *training, *fit));
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
