// fatmc estimate: frequency response matrix of records, with variances and bias, by any of the estimators.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>

#include "coordinator/cli/command.h"
#include "coordinator/cli/estimate_report.h"
#include "coordinator/input/record_file.h"
#include "core/record/column_file.h"

namespace fatmc::cli {
namespace {

/// V_trim / V_mean (3.4). V_trim is `trim_speed_m_s` of the record's TOML, or else the record's first sample.
Result<double> speed_factor(const Record& record, double first_speed, const std::string& file) {
  const int v = record.column("V");
  if (std::find(record.auxiliary.begin(), record.auxiliary.end(), v) == record.auxiliary.end()) {
    return fail(Error{file, 0, "speed-correction", "needs the airspeed: name the column V among the auxiliary channels"});
  }
  const double trim = record.trim_speed_m_s.value_or(first_speed);
  const double factor = std::abs(trim) / std::abs(record.samples.col(v).mean());
  if (!std::isfinite(factor) || factor <= 0.0) {
    return fail(Error{file, 0, "V", "has no mean speed to correct with"});
  }
  return factor;
}

/// A record ready for the method: period and lines known where it needs them, leading periods skipped.
Result<Record> prepare_record(const EstimateArguments& arguments, EstimationMethod method, const std::string& file,
                              double* first_speed) {
  Result<Record> read = read_record(file, arguments.meta);
  if (!read) return fail(read.error());
  Record& record = *read;
  if (Status status = complete_period(record, file); !status) {
    if (needs_period(method)) return fail(status.error());
    if (arguments.skip_periods != 0) {
      return fail(Error{file, 0, "skip-periods", "the record has no periods to skip: " + status.error().message});
    }
    if (record.periods != 1) {  // one period that the record names still says which lines are excited
      record.periods = record.period_samples = 0;
      record.excited_lines.clear();
    }
  }
  const int v = record.column("V");
  *first_speed = v >= 0 ? record.samples(0, v) : 0.0;
  if (Status status = skip_periods(record, arguments.skip_periods, file); !status) return fail(status.error());
  if (!record.reference.empty() && record.reference.size() != record.input.size()) {
    return fail(Error{file, 0, "reference", std::to_string(record.reference.size()) + " references for " +
                                                std::to_string(record.input.size()) +
                                                " inputs: the indirect estimate needs one a input; leave the "
                                                "references out for a direct one"});
  }
  return read;
}

Measurement measurement_of(const Record& record) {
  return {{record.excited_lines, record.period_samples, record.periods, record.rate_hz},
          record.channels(record.output),
          record.channels(record.input),
          record.channels(record.reference)};
}

/// Periodic methods stand or fall with all their lines; the others leave out lines that nothing excites.
Status check_lines(const EstimatedRecord& e, const std::string& file) {
  const FrmEstimate& frm = e.response.frm;
  const bool some = std::find(frm.status.begin(), frm.status.end(), LineStatus::ok) != frm.status.end();
  for (int k = 0; k < frm.line_count(); ++k) {
    const LineStatus status = frm.status[static_cast<std::size_t>(k)];
    if (status == LineStatus::ok || (some && !needs_period(e.method))) continue;
    const std::string what = status == LineStatus::singular_regressor
                                 ? "the excitation channels depend on each other, name independent ones"
                                 : "an input does not follow the references, leave it out";
    return fail(Error{file, 0, "line " + std::to_string(frm.lines[static_cast<std::size_t>(k)]), what});
  }
  return {};
}

Result<EstimatedRecord> estimate(const EstimateArguments& arguments, EstimationMethod method) {
  const std::string& file = arguments.records.front();
  EstimatedRecord out;
  out.method = method;
  std::vector<Measurement> measurements;
  double first_speed = 0.0;
  for (const std::string& path : arguments.records) {
    double speed = 0.0;
    Result<Record> record = prepare_record(arguments, method, path, &speed);
    if (!record) return fail(record.error());
    measurements.push_back(measurement_of(*record));
    if (path != arguments.records.front()) continue;
    out.record = std::move(*record);
    first_speed = speed;
  }
  Result<ResponseEstimate> response = estimate_response(method, measurements, arguments.options);
  if (!response) {
    Error error = response.error();
    if (error.file.empty()) error.file = file;
    return fail(error);
  }
  out.response = std::move(*response);
  if (Status status = check_lines(out, file); !status) return fail(status.error());
  if (arguments.speed_correction) {
    const Result<double> factor = speed_factor(out.record, first_speed, file);
    if (!factor) return fail(factor.error());
    out.speed_factor = *factor;
    scale_response(out.response.frm, *factor);
    for (int k = 0; k < out.response.bias.count(); ++k) out.response.bias[k] *= *factor;
  }
  return out;
}

Exit run_estimate(const EstimateArguments& arguments) {
  const std::optional<EstimationMethod> method = estimation_method(arguments.method);
  if (!method) {
    return report(Error{"", 0, "--method", "\"" + arguments.method + "\" does not exist, there are: " +
                                               estimation_method_names()});
  }
  if (arguments.speed_correction && arguments.records.size() > 1) {
    return report(Error{"", 0, "--speed-correction", "takes one record, correct several by their own speeds first"});
  }
  const Result<EstimatedRecord> result = estimate(arguments, *method);
  if (!result) return report(result.error());
  std::filesystem::create_directories(arguments.directory);
  write_file_atomically(arguments.directory + "/frm.csv", frm_csv(*result));
  write_file_atomically(arguments.directory + "/estimate.json", estimate_json(arguments, *result));
  print_summary(arguments, *result);
  return Exit::done;
}

}  // namespace

void add_estimate_command(CLI::App& app, Exit& exit) {
  auto arguments = std::make_shared<EstimateArguments>();
  EstimatorOptions& options = arguments->options;
  CLI::App* command = app.add_subcommand("estimate", "Frequency response matrix of a record, or of several.");
  command->add_option("record", arguments->records, "RECORD.csv, its RECORD.toml beside it")->required();
  command->add_option("--meta", arguments->meta, "the records' TOML where it is not beside the CSV");
  command->add_option("--method", arguments->method,
                      "lpm: fast local polynomial; tlpm: transient LPM; etfe; lrm: local rational; arbitrary: LPM for any "
                      "excitation; robust: several records; welch: conditioned spectra")
      ->capture_default_str();
  command->add_option("--n-e", options.n_e, "lines (bins) on each side of a line: 9, lrm 6");
  command->add_option("--order", options.order, "degree of the polynomials")->capture_default_str();
  command->add_option("--n-transient", options.n_transient,
                      "non-excited bins on each side of a line: 5, tlpm with 5 periods and more: (periods + order)/2");
  command->add_option("--skip-periods", arguments->skip_periods, "leading periods to leave out")->capture_default_str();
  command->add_option("--segment", options.welch.segment_samples, "welch: samples a segment, 0: a period or an eighth")
      ->capture_default_str();
  command->add_option("--overlap", options.welch.overlap, "welch: share of a segment")->capture_default_str();
  command->add_option("--taper", options.welch.taper, "welch: hann or none")
      ->transform(CLI::CheckedTransformer(std::map<std::string, Taper>{{"hann", Taper::hann}, {"none", Taper::none}}))
      ->default_str("hann");
  command->add_flag("--speed-correction", arguments->speed_correction,
                    "scale with V_trim / V_mean; V must be an auxiliary channel");
  command->add_option("-o,--output", arguments->directory, "directory for frm.csv and estimate.json")->required();
  command->footer("Example: fatmc estimate flight.csv --n-e 9 --skip-periods 1 -o results/flight");
  command->callback([arguments, &exit] { exit = run_estimate(*arguments); });
}

}  // namespace fatmc::cli
