// fatmc predict: what an estimated response makes of another record's inputs, beside its outputs.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <span>

#include "coordinator/cli/command.h"
#include "coordinator/cli/estimate_record.h"
#include "coordinator/cli/output_path.h"
#include "coordinator/input/record_file.h"
#include "coordinator/input/response_file.h"
#include "core/accuracy/series_accuracy.h"
#include "core/base/text.h"
#include "core/ident/output_prediction.h"
#include "core/record/column_file.h"

namespace fatmc::cli {
namespace {

using Json = nlohmann::ordered_json;

struct PredictArguments {
  std::string record, meta, response, directory;
};

struct Predicted {
  Record record;
  OutputPrediction outputs;
};

Result<Predicted> predict(const PredictArguments& arguments) {
  const Result<ResponseTable> table = read_response_table(arguments.response);
  if (!table) return fail(table.error());
  Result<Record> record = read_record(arguments.record, arguments.meta);
  if (!record) return fail(record.error());
  const std::vector<std::string> inputs = channel_names(*record, record->input);
  const auto response =
      matching_response(*table, channel_names(*record, record->output), inputs, arguments.response);
  if (!response) return fail(response.error());
  if (inputs.size() != table->inputs.size()) {
    return fail(Error{arguments.response, 0, "input",
                      "the response has the inputs " + join(table->inputs) +
                          ", the record names fewer of them: a prediction needs all"});
  }
  Result<OutputPrediction> outputs =
      predict_outputs(table->frequency_hz, *response, record->channels(record->output),
                      record->channels(record->input), record->rate_hz);
  if (!outputs) return fail(Error{arguments.record, 0, "", outputs.error().message});
  return Predicted{std::move(*record), std::move(*outputs)};
}

std::span<const double> channel(const Eigen::MatrixXd& samples, Eigen::Index i) {
  return {samples.col(i).data(), static_cast<std::size_t>(samples.rows())};
}

double root_mean_square(const Eigen::Ref<const Eigen::VectorXd>& x) {
  return std::sqrt(x.squaredNorm() / static_cast<double>(x.size()));
}

Json summary(const PredictArguments& arguments, const Predicted& p) {
  const OutputPrediction& o = p.outputs;
  const double per_bin = p.record.rate_hz / p.record.sample_count();
  Json json;
  json["record"] = arguments.record;
  json["response"] = arguments.response;
  json["band_hz"] = {o.first_bin * per_bin, o.last_bin * per_bin};
  json["bins"] = o.last_bin - o.first_bin + 1;
  json["outputs"] = Json::array();
  for (Eigen::Index i = 0; i < o.vaf.size(); ++i) {
    const auto measured = channel(o.measured, i), predicted = channel(o.predicted, i);
    const auto optional = [](std::optional<double> value) { return value ? Json(*value) : Json(); };
    json["outputs"].push_back(
        {{"output", p.record.names[static_cast<std::size_t>(p.record.output[static_cast<std::size_t>(i)])]},
         {"vaf_percent", 100.0 * o.vaf(i)},
         {"theil", optional(theil_coefficient(measured, predicted))},
         {"index_of_agreement", optional(index_of_agreement(measured, predicted))},
         {"rms_measured", root_mean_square(o.measured.col(i))},
         {"rms_error", root_mean_square(o.measured.col(i) - o.predicted.col(i))},
         {"band_share_percent", 100.0 * o.band_share(i)}});
  }
  return json;
}

void print(const Json& json) {
  std::printf("%s by %s: %d bins, %s to %s Hz\n", json["record"].get<std::string>().c_str(),
              json["response"].get<std::string>().c_str(), json["bins"].get<int>(),
              significant(json["band_hz"][0], 4).c_str(), significant(json["band_hz"][1], 4).c_str());
  std::printf("  %-12s %8s %8s %8s %12s %12s %14s\n", "output", "VAF %", "Theil", "d1", "rms", "rms error",
              "in the band %");
  const auto number = [](const Json& value, int digits) {
    return value.is_null() ? std::string("-") : fixed(value, digits);
  };
  for (const Json& o : json["outputs"]) {
    std::printf("  %-12s %8s %8s %8s %12s %12s %14s\n", o["output"].get<std::string>().c_str(),
                number(o["vaf_percent"], 3).c_str(), number(o["theil"], 4).c_str(),
                number(o["index_of_agreement"], 4).c_str(), significant(o["rms_measured"], 4).c_str(),
                significant(o["rms_error"], 4).c_str(), number(o["band_share_percent"], 1).c_str());
  }
}

void write_series(const std::string& path, const Predicted& p) {
  const Eigen::Index n = p.outputs.measured.rows(), outputs = p.outputs.measured.cols();
  std::vector<std::string> names = {"t"};
  Eigen::MatrixXd values(n, 1 + 2 * outputs);
  values.col(0) = Eigen::VectorXd::LinSpaced(n, 0.0, static_cast<double>(n - 1)) / p.record.rate_hz;
  for (Eigen::Index i = 0; i < outputs; ++i) {
    const std::string& name =
        p.record.names[static_cast<std::size_t>(p.record.output[static_cast<std::size_t>(i)])];
    names.insert(names.end(), {name + "_measured", name + "_predicted"});
    values.col(1 + 2 * i) = p.outputs.measured.col(i);
    values.col(2 + 2 * i) = p.outputs.predicted.col(i);
  }
  write_columns(path, names, values);
}

Exit run_predict(const PredictArguments& arguments) {
  if (!arguments.directory.empty()) {
    if (Status status = check_output_directory(arguments.directory); !status) return report(status.error());
  }
  const Result<Predicted> predicted = predict(arguments);
  if (!predicted) return report(predicted.error());
  const Json json = summary(arguments, *predicted);
  print(json);
  if (arguments.directory.empty()) return Exit::done;
  std::filesystem::create_directories(arguments.directory);
  write_series(arguments.directory + "/predicted.csv", *predicted);
  write_file_atomically(arguments.directory + "/prediction.json", json.dump(2) + "\n");
  std::printf("written: %s/predicted.csv, %s/prediction.json\n", arguments.directory.c_str(),
              arguments.directory.c_str());
  return Exit::done;
}

}  // namespace

void add_predict_command(CLI::App& app, Exit& exit) {
  auto arguments = std::make_shared<PredictArguments>();
  CLI::App* command = app.add_subcommand(
      "predict", "Outputs of a record from its inputs and an estimated response, and how well they agree.");
  command
      ->add_option("record", arguments->record,
                   "RECORD.csv or RECORD.mat, its RECORD.toml beside it: not one of the estimate")
      ->required();
  command->add_option("--response", arguments->response, "frm.csv of `fatmc estimate`")->required();
  command->add_option("--meta", arguments->meta, "the record's TOML where it is not beside it");
  command->add_option("-o,--output", arguments->directory,
                      "directory for predicted.csv and prediction.json; absent: only printed");
  command->footer(
      "Example: fatmc predict validation.csv --response results/sweeps/frm.csv -o results/prediction\n"
      "docs/measured_data.md goes through one from sweeps to validation.");
  command->callback([arguments, &exit] { exit = run_predict(*arguments); });
}

}  // namespace fatmc::cli
