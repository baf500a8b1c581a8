// fatmc estimate: frequency response matrix of records, with variances and bias, by any of the estimators.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <thread>

#include "coordinator/cli/command.h"
#include "coordinator/cli/estimate_plots.h"
#include "coordinator/cli/estimate_report.h"
#include "coordinator/cli/output_path.h"
#include "coordinator/plot/svg.h"
#include "core/record/column_file.h"

namespace fatmc::cli {
namespace {

struct Plot {
  std::string file, svg;
};

/// What --plots and --reference ask for.
Result<std::vector<Plot>> draw(const EstimateArguments& arguments, const EstimatedRecord& estimated) {
  std::vector<Plot> out;
  if (!arguments.plots && arguments.reference.empty()) return out;
  std::optional<ReferenceResponse> reference;
  if (!arguments.reference.empty()) {
    Result<ReferenceResponse> read = read_reference_response(arguments.reference, estimated);
    if (!read) return fail(read.error());
    reference = std::move(*read);
  }
  out.push_back({"response.svg", plot::svg_of(response_figure(estimated, reference))});
  if (reference) out.push_back({"error.svg", plot::svg_of(error_figure(estimated, *reference))});
  return out;
}

Exit run_estimate(const EstimateArguments& arguments) {
  const std::optional<EstimationMethod> method = estimation_method(arguments.method);
  if (!method) {
    return report(
        Error{"", 0, "--method",
              "\"" + arguments.method + "\" does not exist, there are: " + estimation_method_names()});
  }
  if (arguments.speed_correction && arguments.records.size() > 1) {
    return report(
        Error{"", 0, "--speed-correction", "takes one record, correct several by their own speeds first"});
  }
  if (Status status = check_output_directory(arguments.directory); !status) return report(status.error());
  const Result<EstimatedRecord> result = estimate_records(arguments, *method);
  if (!result) return report(result.error());
  const Result<std::vector<Plot>> plots = draw(arguments, *result);
  if (!plots) return report(plots.error());
  std::filesystem::create_directories(arguments.directory);
  write_file_atomically(arguments.directory + "/frm.csv", frm_csv(*result));
  write_file_atomically(arguments.directory + "/estimate.json", estimate_json(arguments, *result));
  for (const Plot& plot : *plots) write_file_atomically(arguments.directory + "/" + plot.file, plot.svg);
  print_summary(arguments, *result);
  for (const Plot& plot : *plots)
    std::printf("plot: %s/%s\n", arguments.directory.c_str(), plot.file.c_str());
  return Exit::done;
}

}  // namespace

void add_estimate_command(CLI::App& app, Exit& exit) {
  auto arguments = std::make_shared<EstimateArguments>();
  EstimatorOptions& options = arguments->estimator;
  CLI::App* command = app.add_subcommand("estimate", "Frequency response matrix of a record, or of several.");
  command->add_option("record", arguments->records, "RECORD.csv or RECORD.mat, its RECORD.toml beside it")
      ->required();
  command
      ->add_option("--method", arguments->method,
                   "lpm: fast local polynomial; tlpm: transient LPM; etfe; lrm: local rational; arbitrary: "
                   "LPM for any "
                   "excitation; robust: several records; welch: conditioned spectra")
      ->capture_default_str();
  add_estimate_options(*command, *arguments);
  command
      ->add_option("--segment", options.welch.segment_samples,
                   "welch: samples a segment, 0: a period or an eighth")
      ->capture_default_str();
  command
      ->add_option("--overlap", options.welch.overlap,
                   "welch: share of a segment; half of it is what a Hann taper leaves unused")
      ->capture_default_str();
  command
      ->add_option("--taper", options.welch.taper,
                   "welch: hann or none; Hann where segments are no whole periods, none where they are")
      ->transform(
          CLI::CheckedTransformer(std::map<std::string, Taper>{{"hann", Taper::hann}, {"none", Taper::none}}))
      ->default_str("hann");
  command->add_flag(
      "--bias-variants", arguments->bias_variants,
      "lpm: the bias with the printed, the limit's and the actual constants side by side in estimate.json");
  options.threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  command
      ->add_option("--threads", options.threads,
                   "lrm: cores for the lines, default all; the result does not depend on it")
      ->check(CLI::Range(1, 1024));
  command->add_flag("--plots", arguments->plots,
                    "also draw response.svg: magnitude, phase and confidence region of every element");
  command->add_option(
      "--reference", arguments->reference,
      "MODEL (TOML of kind aircraft, state_space or frf) or frm.csv to draw beside it, with MUAD "
      "envelopes, and error.svg: the error response function");
  command->add_option("-o,--output", arguments->directory, "directory for frm.csv and estimate.json")
      ->required();
  command->footer("Example: fatmc estimate flight.csv --n-e 9 --skip-periods 1 -o results/flight");
  command->callback([arguments, &exit] { exit = run_estimate(*arguments); });
}

}  // namespace fatmc::cli
