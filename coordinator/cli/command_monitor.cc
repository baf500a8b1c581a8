// fatmc monitor: confident stability level over a window that moves along a record or a stream of samples.
#include <cmath>
#include <cstdio>
#include <functional>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "coordinator/cli/bias_choice.h"
#include "coordinator/cli/command.h"
#include "coordinator/cli/estimate_record.h"
#include "coordinator/cli/loop_controller.h"
#include "coordinator/input/nominal_plant_file.h"
#include "coordinator/input/record_file.h"
#include "core/base/text.h"
#include "core/record/column_stream.h"
#include "core/stability/stability_monitor.h"

namespace fatmc::cli {
namespace {

using Json = nlohmann::ordered_json;

struct MonitorArguments {
  std::string record, meta, nominal;
  std::string combine = "bonferroni";
  BiasChoice bias;
  StabilityOptions options;
  LpmOptions lpm;
  int window_periods = 2;
  double every_s = 1.0;
  std::optional<double> gain;
};

Result<StabilityMonitor> make_monitor(const MonitorArguments& arguments, const Record& record) {
  if (record.reference.size() != record.input.size()) {
    return fail(Error{arguments.record, 0, "reference",
                      std::to_string(record.reference.size()) + " references for " +
                          std::to_string(record.input.size()) +
                          " inputs: the monitor estimates in closed loop and needs one an input"});
  }
  const Result<LpmGrid> grid =
      LpmGrid::create({record.excited_lines, record.period_samples, arguments.window_periods, record.rate_hz},
                      arguments.lpm, static_cast<int>(record.input.size()));
  if (!grid) return fail(Error{arguments.record, 0, grid.error().key, grid.error().message});
  const Result<Eigen::MatrixXd> controller = loop_controller(record, arguments.gain, arguments.record);
  if (!controller) return fail(controller.error());
  std::vector<double> frequency_hz;
  for (int k = 0; k < grid->line_count(); ++k) frequency_hz.push_back(grid->frequency_hz(k));
  const Result<NominalPlant> nominal = read_nominal_plant(
      arguments.nominal, {channel_names(record, record.input), channel_names(record, record.output),
                          record.rate_hz, record.hold, *controller, frequency_hz});
  if (!nominal) return fail(nominal.error());
  const std::string missing = effects_not_shown(*nominal, arguments.nominal);
  if (!missing.empty())
    std::fprintf(stderr, "fatmc: %s\n", missing.c_str());  // standard output carries epochs
  return StabilityMonitor(*grid, static_cast<int>(record.output.size()), nominal->loop, arguments.options,
                          arguments.bias.constant());
}

/// Feeds rows to a monitor and prints an epoch whenever one is due.
class EpochPrinter {
 public:
  EpochPrinter(StabilityMonitor monitor, const Record& record, double every_s)
      : monitor_(std::move(monitor)),
        record_(record),
        every_(std::max<std::int64_t>(1, std::llround(every_s * record.rate_hz))) {}

  void take(const std::function<double(int)>& value) {
    gather(record_.output, value, outputs_);
    gather(record_.input, value, inputs_);
    gather(record_.reference, value, references_);
    monitor_.push(outputs_, inputs_, references_);
    if (++samples_ % every_ == 0) print();
  }

 private:
  static void gather(const std::vector<int>& columns, const std::function<double(int)>& value,
                     std::vector<double>& out) {
    out.clear();
    for (const int column : columns) out.push_back(value(column));
  }

  void print() {
    const MonitorEpoch epoch = monitor_.epoch();
    Json json;
    json["t"] = static_cast<double>(samples_ - 1) / record_.rate_hz;
    json["p_total_ssv"] = epoch.band.p_total_ssv;
    json["p_total_hinf"] = epoch.band.p_total_h_infinity;
    json["nominal_stable"] = epoch.band.nominally_stable_ssv;
    json["window_full"] = epoch.window_full;
    json["p_band_ssv"] = epoch.band.p_ssv;  // without the gates of nominal stability and SNR
    json["p_band_hinf"] = epoch.band.p_h_infinity;
    json["low_snr_lines"] = epoch.band.low_snr_lines;
    std::printf("%s\n", json.dump().c_str());
    std::fflush(stdout);  // whoever reads along waits for this line
  }

  StabilityMonitor monitor_;
  const Record& record_;
  std::int64_t every_, samples_ = 0;
  std::vector<double> outputs_, inputs_, references_;
};

Exit monitor_file(const MonitorArguments& arguments) {
  Result<Record> record = read_record(arguments.record, arguments.meta);
  if (!record) return report(record.error());
  if (Status status = complete_period(*record, arguments.record); !status) return report(status.error());
  Result<StabilityMonitor> monitor = make_monitor(arguments, *record);
  if (!monitor) return report(monitor.error());
  EpochPrinter printer(std::move(*monitor), *record, arguments.every_s);
  for (Eigen::Index row = 0; row < record->samples.rows(); ++row) {
    printer.take([&](int column) { return record->samples(row, column); });
  }
  return Exit::done;
}

Exit monitor_stream(const MonitorArguments& arguments) {
  if (arguments.meta.empty()) {
    return report(Error{"", 0, "--meta",
                        "is needed for samples on standard input: a TOML with [record], as beside a CSV"});
  }
  std::ios::sync_with_stdio(false);
  Result<ColumnStream> stream = ColumnStream::open(std::cin, "standard input");
  if (!stream) return report(stream.error());
  Result<Record> record = read_stream_roles("standard input", stream->names(), arguments.meta);
  if (!record) return report(record.error());
  Result<StabilityMonitor> monitor = make_monitor(arguments, *record);
  if (!monitor) return report(monitor.error());
  EpochPrinter printer(std::move(*monitor), *record, arguments.every_s);
  std::vector<double> row;
  while (true) {
    const Result<bool> more = stream->next(row);
    if (!more) return report(more.error());
    if (!*more) return Exit::done;
    printer.take([&](int column) { return row[static_cast<std::size_t>(column)]; });
  }
}

Exit run_monitor(MonitorArguments& arguments) {
  arguments.options.combine = arguments.combine == "min" ? CombinationRule::min : CombinationRule::bonferroni;
  arguments.options.bias = arguments.bias.counted();
  return arguments.record == "-" ? monitor_stream(arguments) : monitor_file(arguments);
}

}  // namespace

void add_monitor_command(CLI::App& app, Exit& exit) {
  auto arguments = std::make_shared<MonitorArguments>();
  CLI::App* command = app.add_subcommand(
      "monitor", "Confident stability level over a moving window: a line of JSON an epoch.");
  command
      ->add_option("record", arguments->record,
                   "RECORD.csv or .mat; - for CSV rows on standard input (default)")
      ->default_str("-")
      ->default_val("-");
  command->add_option("--nominal", arguments->nominal, "MODEL known to be stable, as in fatmc stability")
      ->required();
  command->add_option("--meta", arguments->meta,
                      "the record's TOML; for standard input with rate_hz, period_samples and excited_lines");
  command
      ->add_option("--window-periods", arguments->window_periods,
                   "length of the window in periods of the excitation")
      ->check(CLI::Range(2, 1000))
      ->capture_default_str();
  command->add_option("--every", arguments->every_s, "s from epoch to epoch")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command
      ->add_option("--combine", arguments->combine,
                   "over the elements of a line: bonferroni (Fig. 5-16) or min")
      ->check(CLI::IsMember({"min", "bonferroni"}))
      ->capture_default_str();
  add_bias_option(*command, arguments->bias);
  command
      ->add_option("--intergrid", arguments->options.intergrid, "allowance for what lies between the lines")
      ->check(CLI::Range(0.0, 100.0))
      ->capture_default_str();
  command->add_option("--gain", arguments->gain,
                      "K is this times the identity; absent: controller_gain of the TOML");
  command->add_option("--n-e", arguments->lpm.n_e, "lines on each side of a line")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  command->add_option("--order", arguments->lpm.order, "degree of the polynomials")
      ->check(CLI::Range(0, 10))
      ->capture_default_str();
  command->add_option("--n-transient", arguments->lpm.n_transient, "non-excited bins on each side of a line")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  command->footer(
      "Example: fatmc monitor flight.csv --nominal campaigns/models/fat.toml --every 10\n"
      "         telemetry | fatmc monitor - --meta flight.toml --nominal campaigns/models/fat.toml");
  command->callback([arguments, &exit] { exit = run_monitor(*arguments); });
}

}  // namespace fatmc::cli
