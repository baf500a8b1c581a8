// fatmc noise: spectra of a record with fixed controls, and how large noise gets.
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "coordinator/cli/command.h"
#include "coordinator/cli/output_path.h"
#include "coordinator/input/record_file.h"
#include "core/base/text.h"
#include "core/ident/noise_model.h"
#include "core/record/column_file.h"
#include "core/stats/confidence_regions.h"

namespace fatmc::cli {
namespace {

struct NoiseArguments {
  std::string record, meta, directory;
  int segment = 0;
  double level = 0.95;
};

std::size_t index(int i) { return static_cast<std::size_t>(i); }

/// Radius over deviation for all of a vector of n channels at once; 0 where q is too small.
double shadow(const NoiseArguments& arguments, int n, int q) {
  return region_radius(RegionKind::simultaneous, arguments.level, n, 1, q).value_or(0.0);
}

std::string noise_csv(const NoiseArguments& arguments, const Record& record, const NoiseModel& model) {
  const double one = *region_radius(RegionKind::univariate, arguments.level, 1, 1, model.q());
  const auto n_out = static_cast<int>(record.output.size()), n_in = static_cast<int>(record.input.size());
  const double outputs = shadow(arguments, n_out, model.q()), inputs = shadow(arguments, n_in, model.q());
  std::string text = "frequency_hz,channel,deviation,density,radius,radius_simultaneous\n";
  for (std::size_t k = 0; k < model.frequency_hz.size(); ++k) {
    for (int i = 0; i < model.channels; ++i) {
      const double deviation = std::sqrt(model.covariance[static_cast<int>(k)](i, i).real());
      const int column = i < n_out ? record.output[index(i)] : record.input[index(i - n_out)];
      const double all = i < n_out ? outputs : inputs;
      text += shortest(model.frequency_hz[k]) + "," + record.names[index(column)] + "," +
              shortest(deviation) + "," + shortest(model.density(static_cast<int>(k), i)) + "," +
              shortest(one * deviation) + "," + (all > 0.0 ? shortest(all * deviation) : "") + "\n";
    }
  }
  return text;
}

std::string noise_json(const NoiseArguments& arguments, const Record& record, const NoiseModel& model) {
  nlohmann::ordered_json json;
  json["segments"] = model.segments;
  json["q"] = model.q();
  json["segment_samples"] = model.segment_samples;
  json["rate_hz"] = model.rate_hz;
  json["resolution_hz"] = model.rate_hz / model.segment_samples;
  json["left_out_samples"] = record.sample_count() - model.segments * model.segment_samples;
  json["relative_error_of_variance"] = 1.0 / std::sqrt(static_cast<double>(model.q()));
  json["level"] = arguments.level;
  json["conventions"] = {
      {"deviation", "of one segment's spectrum, N^(-1/2) sum x[n] exp(-j 2 pi k n / N), (2.44)"},
      {"density", "two-sided, per Hz"},
      {"radius", "holds one channel's spectrum with probability level, F(2, 2q) (A.11, A.12 corrected)"},
      {"radius_simultaneous",
       "holds all outputs, or all inputs, at once (A.14, A.15 corrected); empty where q is below their "
       "number"}};
  return json.dump(2) + "\n";
}

Exit run_noise(const NoiseArguments& arguments) {
  if (Status status = check_output_directory(arguments.directory); !status) return report(status.error());
  const Result<Record> record = read_record(arguments.record, arguments.meta);
  if (!record) return report(record.error());
  Eigen::MatrixXd samples(record->sample_count(),
                          static_cast<Eigen::Index>(record->output.size() + record->input.size()));
  samples << record->channels(record->output), record->channels(record->input);
  const int segment =
      arguments.segment > 0 ? arguments.segment : record->sample_count() / 21;  // q = 20: 22 % of a variance
  Result<NoiseModel> model = noise_model(samples, record->rate_hz, segment);
  if (!model) {
    Error error = model.error();
    error.file = arguments.record;
    return report(error);
  }
  std::filesystem::create_directories(arguments.directory);
  write_file_atomically(arguments.directory + "/noise.csv", noise_csv(arguments, *record, *model));
  write_file_atomically(arguments.directory + "/noise.json", noise_json(arguments, *record, *model));
  std::printf("%s: %d segments of %d samples, resolution %s Hz, variances to %s %%\n",
              arguments.record.c_str(), model->segments, model->segment_samples,
              significant(model->rate_hz / model->segment_samples, 4).c_str(),
              significant(100.0 / std::sqrt(static_cast<double>(model->q())), 2).c_str());
  std::printf("written: %s/noise.csv, %s/noise.json\n", arguments.directory.c_str(),
              arguments.directory.c_str());
  return Exit::done;
}

}  // namespace

void add_noise_command(CLI::App& app, Exit& exit) {
  auto arguments = std::make_shared<NoiseArguments>();
  CLI::App* command = app.add_subcommand(
      "noise", "Noise of outputs and inputs from a record with fixed controls (T A.7, A.8).");
  command->add_option("record", arguments->record, "RECORD.csv, its RECORD.toml beside it")->required();
  command->add_option("--meta", arguments->meta, "the record's TOML where it is not beside the CSV");
  command
      ->add_option("--segment", arguments->segment,
                   "samples a segment; 0: a 21st of the record, variances to 22 %")
      ->check(CLI::Range(0, 100000000))
      ->capture_default_str();
  command->add_option("--level", arguments->level, "probability of the radii")
      ->check(CLI::Range(0.01, 0.9999))
      ->capture_default_str();
  command->add_option("-o,--output", arguments->directory, "directory for noise.csv and noise.json")
      ->required();
  command->footer("Example: fatmc noise calm.csv --segment 1000 -o results/noise");
  command->callback([arguments, &exit] { exit = run_noise(*arguments); });
}

}  // namespace fatmc::cli
