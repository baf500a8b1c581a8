// fatmc identify: a state-space model of records by PBSIDopt.
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>

#include "coordinator/cli/command.h"
#include "coordinator/cli/identify_record.h"
#include "coordinator/cli/output_path.h"
#include "coordinator/cli/regularization_option.h"
#include "coordinator/cli/state_space_file.h"
#include "core/base/text.h"
#include "core/record/column_file.h"

namespace fatmc::cli {
namespace {

using Json = nlohmann::ordered_json;

Json rows(const Eigen::MatrixXd& matrix) {
  Json out = Json::array();
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    Json row = Json::array();
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) row.push_back(matrix(i, j));
    out.push_back(row);
  }
  return out;
}

Json complex_list(const Eigen::VectorXcd& values) {
  Json out = Json::array();
  for (const std::complex<double>& value : values) out.push_back({value.real(), value.imag()});
  return out;
}

Json optional_number(const std::optional<double>& value) { return value ? Json(*value) : Json(); }

Json scores(const std::vector<ManeuverScore>& maneuvers) {
  Json out = Json::array();
  for (const ManeuverScore& maneuver : maneuvers) {
    Json entry = {{"maneuver", maneuver.name}};
    if (!maneuver.failure.empty()) {
      entry["failure"] = maneuver.failure;
      out.push_back(entry);
      continue;
    }
    entry["rms"] = maneuver.rms;
    entry["overall_agreement"] = optional_number(maneuver.overall_agreement);
    for (const OutputScore& output : maneuver.outputs) {
      entry["outputs"].push_back({{"output", output.output},
                                  {"variance_accounted_for", output.variance_accounted_for},
                                  {"rms", output.rms},
                                  {"theil", optional_number(output.theil)},
                                  {"agreement", optional_number(output.agreement)}});
    }
    out.push_back(entry);
  }
  return out;
}

std::string model_json(const IdentifyArguments& arguments, const IdentifiedRecords& result) {
  const PbsidModel& model = result.model;
  Json json;
  json["inputs"] = result.inputs;
  json["outputs"] = result.outputs;
  json["rate_hz"] = result.rate_hz;
  json["past"] = arguments.pbsid.past;
  json["future"] = arguments.pbsid.future;
  json["order"] = arguments.pbsid.order;
  json["lambda"] = model.lambda;
  json["A"] = rows(model.a);
  json["B"] = rows(model.b);
  json["C"] = rows(model.c);
  json["K"] = rows(model.k);
  json["A_ct"] = result.continuous ? rows(result.continuous->a) : Json();
  json["B_ct"] = result.continuous ? rows(result.continuous->b) : Json();
  json["C_ct"] = result.continuous ? rows(result.continuous->c) : Json();
  json["D_ct"] = result.continuous ? rows(result.continuous->d) : Json();
  json["continuous"] = arguments.continuation == Continuation::zoh ? "zoh" : "bilinear";
  json["eigenvalues"] = complex_list(model.eigenvalues);
  json["singular_values"] = std::vector<double>(model.singular_values.begin(), model.singular_values.end());
  json["predictor_norm"] = model.predictor_norm;
  json["predictor_radius"] = model.predictor_radius;
  json["riccati_residual"] = model.riccati_residual;
  json["innovation_covariance"] = rows(model.innovation);
  json["freedom"] = model.freedom;
  json["identification"] = scores(result.identification);
  json["validation"] = scores(result.validation);
  return json.dump(2) + "\n";
}

void print_modes(const IdentifiedRecords& result) {
  std::printf("  mode   frequency Hz   damping   period s   time constant s\n");
  const auto modal = modal_model({result.model.a, result.model.b, result.model.c});
  if (!modal) return;
  int number = 0;
  for (const std::complex<double>& z : modal->eigenvalues) {
    if (z.imag() < 0.0) continue;
    const std::complex<double> s = std::log(z) * result.rate_hz;
    const double natural = std::abs(s);
    std::printf("  %4d   %12s   %7s   %8s   %s\n", ++number, significant(natural / (2.0 * M_PI), 4).c_str(),
                natural > 0.0 ? fixed(-s.real() / natural, 3).c_str() : "-",
                z.imag() > 0.0 ? significant(2.0 * M_PI / s.imag(), 4).c_str() : "-",
                s.real() != 0.0 ? significant(-1.0 / s.real(), 4).c_str() : "-");
  }
}

/// A model that runs away has a figure without meaning.
std::string percent(double value) { return value < -999.0 ? "< -999" : fixed(value, 1); }

void print_scores(const char* title, const std::vector<ManeuverScore>& maneuvers) {
  for (const ManeuverScore& maneuver : maneuvers) {
    if (!maneuver.failure.empty()) {
      std::printf("%s %s: %s\n", title, maneuver.name.c_str(), maneuver.failure.c_str());
      continue;
    }
    std::printf("%s %s: overall index of agreement %s\n", title, maneuver.name.c_str(),
                maneuver.overall_agreement ? fixed(*maneuver.overall_agreement, 3).c_str() : "-");
    for (const OutputScore& output : maneuver.outputs) {
      const bool identified = output.variance_accounted_for > 0.0;
      std::printf("  %-8s variance accounted for %6s %%  rms %-9s Theil %s  d1 %s%s\n", output.output.c_str(),
                  percent(output.variance_accounted_for).c_str(), significant(output.rms, 3).c_str(),
                  output.theil ? fixed(*output.theil, 3).c_str() : "-",
                  output.agreement ? fixed(*output.agreement, 3).c_str() : "-",
                  identified ? "" : "  not identified: no better than its mean");
    }
  }
}

void print_cautions(const PbsidModel& model) {
  if (model.eigenvalues.cwiseAbs().maxCoeff() >= 1.0) {
    std::printf("the model is unstable, largest |eigenvalue| of A %s\n",
                significant(model.eigenvalues.cwiseAbs().maxCoeff(), 6).c_str());
  }
  if (model.predictor_radius >= 1.0) {
    std::printf(
        "the predictor is unstable, largest |eigenvalue| of A - K C %s: the method assumes that it is "
        "stable; take "
        "--final paper, or another past\n",
        significant(model.predictor_radius, 6).c_str());
  } else if (model.predictor_norm > 1e-3) {
    std::printf("A_K^p is not negligible (norm above 1e-3): lengthen the past window\n");
  }
}

void print_result(const IdentifyArguments& arguments, const IdentifiedRecords& result) {
  const PbsidModel& model = result.model;
  std::printf(
      "%zu record%s, %lld samples at %s Hz: past %d, future %d, order %d, lambda %s, %s parameters an "
      "output\n",
      arguments.records.size(), arguments.records.size() == 1 ? "" : "s",
      static_cast<long long>(result.samples), shortest(result.rate_hz).c_str(), arguments.pbsid.past,
      arguments.pbsid.future, arguments.pbsid.order, significant(model.lambda, 3).c_str(),
      significant(model.freedom, 4).c_str());
  std::printf("spectral norm of A_K^p %s, largest |eigenvalue| of A %s, of A - K C %s\n",
              significant(model.predictor_norm, 3).c_str(),
              significant(model.eigenvalues.cwiseAbs().maxCoeff(), 6).c_str(),
              significant(model.predictor_radius, 6).c_str());
  print_modes(result);
  print_scores("identification", result.identification);
  print_scores("validation", result.validation);
  print_cautions(model);
  if (!result.continuous) std::printf("no continuous model: %s\n", result.continuous_failure.c_str());
  std::printf("written: %s/model.json, %s/model.toml\n", arguments.directory.c_str(),
              arguments.directory.c_str());
}

Exit run_identify(IdentifyArguments& arguments, const std::string& regularization) {
  if (Status status = read_regularization(regularization, arguments.pbsid.regularization); !status) {
    return report(status.error());
  }
  if (Status status = check_output_directory(arguments.directory); !status) return report(status.error());
  const auto result = identify_records(arguments);
  if (!result) return report(result.error());
  std::filesystem::create_directories(arguments.directory);
  write_file_atomically(arguments.directory + "/model.json", model_json(arguments, *result));
  write_file_atomically(
      arguments.directory + "/model.toml",
      state_space_toml("identified by fatmc identify, offsets of the records removed", result->rate_hz,
                       result->inputs, result->outputs, {result->model.a, result->model.b, result->model.c}));
  print_result(arguments, *result);
  return Exit::done;
}

}  // namespace

void add_identify_command(CLI::App& app, Exit& exit) {
  auto arguments = std::make_shared<IdentifyArguments>();
  auto regularization = std::make_shared<std::string>("gcv");
  CLI::App* command =
      app.add_subcommand("identify", "State-space model of records by PBSIDopt, open or closed loop.");
  add_record_options(*command, *arguments);
  command->add_option("--past", arguments->pbsid.past, "past window p in samples: until A_K^p is negligible")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  command->add_option("--future", arguments->pbsid.future, "future window f <= p")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  command->add_option("--order", arguments->pbsid.order, "number of states n")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command->add_option("--regularization", *regularization, kRegularizationHelp)->capture_default_str();
  command
      ->add_option("--final", arguments->pbsid.final_regression,
                   "paper: A, B, C by regression, K by the Riccati equation, predictor stable; residual: A, "
                   "B, K in one "
                   "regression on the innovations")
      ->transform(CLI::CheckedTransformer(std::map<std::string, FinalRegression>{
          {"paper", FinalRegression::paper}, {"residual", FinalRegression::residual}}))
      ->default_str("paper");
  command->add_option("--continuous", arguments->continuation, "zoh: inputs held between samples; bilinear")
      ->transform(CLI::CheckedTransformer(std::map<std::string, Continuation>{
          {"zoh", Continuation::zoh}, {"bilinear", Continuation::bilinear}}))
      ->default_str("zoh");
  command->add_option("-o,--output", arguments->directory, "directory for model.json and model.toml")
      ->required();
  command->footer(
      "Example: fatmc identify flight.csv --past 60 --future 30 --order 8 --hold-back 0.4 -o results/model");
  command->callback([arguments, regularization, &exit] { exit = run_identify(*arguments, *regularization); });
}

}  // namespace fatmc::cli
