#include "coordinator/cli/record_maneuvers.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <utility>

#include "coordinator/cli/estimate_record.h"
#include "coordinator/input/record_file.h"
#include "core/accuracy/series_accuracy.h"
#include "core/base/text.h"
#include "core/signal/decimate.h"
#include "core/subspace/model_fit.h"

namespace fatmc::cli {
namespace {

/// Channels and rate of the first record; all others have to agree with it.
struct Channels {
  std::vector<std::string> inputs, outputs;
  double rate_hz = 0.0;
};

Result<NamedManeuver> read_maneuver(const std::string& file, const RecordSelection& selection,
                                    Channels& channels) {
  Result<Record> record = read_record(file, selection.meta);
  if (!record) return fail(record.error());
  const Channels own{channel_names(*record, record->input), channel_names(*record, record->output),
                     record->rate_hz};
  if (channels.inputs.empty()) channels = own;
  if (own.inputs != channels.inputs || own.outputs != channels.outputs) {
    return fail(Error{file, 0, "record",
                      "has the inputs " + join(own.inputs) + " and outputs " + join(own.outputs) +
                          ", the first record " + join(channels.inputs) + " and " + join(channels.outputs) +
                          ": give all the same roles in the same order"});
  }
  if (std::abs(own.rate_hz - channels.rate_hz) > 1e-9 * channels.rate_hz) {
    return fail(Error{file, 0, "rate_hz",
                      shortest(own.rate_hz) + " Hz, the first record " + shortest(channels.rate_hz) +
                          " Hz: bring them to one rate"});
  }
  if (record->sample_count() <= 10 * selection.decimation) {
    return fail(
        Error{file, 0, "--decimate",
              "the record has too few samples for a factor of " + std::to_string(selection.decimation)});
  }
  return NamedManeuver{std::filesystem::path(file).filename().string(),
                       {decimate(record->channels(record->input), selection.decimation),
                        decimate(record->channels(record->output), selection.decimation)}};
}

/// Takes the last share off into a maneuver of its own. Offsets of the rest hold for it, since trim is the
/// record's.
NamedManeuver cut_end(NamedManeuver& whole, double share) {
  const Eigen::Index n = whole.maneuver.samples();
  const auto kept = n - static_cast<Eigen::Index>(std::floor(share * static_cast<double>(n)));
  NamedManeuver end{
      whole.name + " (held back)",
      {whole.maneuver.inputs.bottomRows(n - kept), whole.maneuver.outputs.bottomRows(n - kept)}};
  whole.maneuver.inputs.conservativeResize(kept, Eigen::NoChange);
  whole.maneuver.outputs.conservativeResize(kept, Eigen::NoChange);
  return end;
}

void remove_offset(NamedManeuver& maneuver, OffsetRemoval rule) {
  remove_offsets(std::span<Maneuver>(&maneuver.maneuver, 1), rule);
}

std::vector<Maneuver> without_names(const std::vector<NamedManeuver>& maneuvers) {
  std::vector<Maneuver> out;
  for (const NamedManeuver& maneuver : maneuvers) out.push_back(maneuver.maneuver);
  return out;
}

Status check_weights(const RecordSelection& selection, const Channels& channels) {
  const std::vector<double>& weights = selection.weights;
  if (weights.empty()) return {};
  if (weights.size() != channels.outputs.size()) {
    return fail(Error{selection.records.front(), 0, "--weights",
                      std::to_string(weights.size()) + " for " + std::to_string(channels.outputs.size()) +
                          " outputs: give one an output, in the order " + join(channels.outputs)});
  }
  if (*std::max_element(weights.begin(), weights.end()) > 0.0) return {};
  return fail(Error{"", 0, "--weights", "at least one output has to count: give one a weight above 0"});
}

}  // namespace

void add_record_options(CLI::App& command, RecordSelection& selection) {
  command
      .add_option("record", selection.records,
                  "RECORD.csv, its RECORD.toml beside it; several: one model of all")
      ->required();
  command.add_option("--validate", selection.validation,
                     "records that the model is to repeat, not used to identify it");
  command
      .add_option("--hold-back", selection.hold_back, "share at the end of each record kept for validation")
      ->check(CLI::Range(0.0, 0.9))
      ->capture_default_str();
  command.add_option("--meta", selection.meta, "TOML of all records, instead of the one beside each");
  command
      .add_option("--offset", selection.offset,
                  "what is taken off each channel of a record: mean, first sample or none")
      ->transform(CLI::CheckedTransformer(std::map<std::string, OffsetRemoval>{
          {"mean", OffsetRemoval::mean}, {"first", OffsetRemoval::first}, {"none", OffsetRemoval::none}}))
      ->default_str("mean");
  command.add_option("--decimate", selection.decimation, "low pass without delay, then every N-th sample")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command
      .add_option(
          "--weights", selection.weights,
          "of the outputs in the overall d1 (H 11), for instance 1,1,2; 0 leaves one out (default: 1 each)")
      ->delimiter(',')
      ->check(CLI::Range(0.0, 100.0));
}

std::vector<Maneuver> RecordManeuvers::data() const { return without_names(identification); }

std::vector<Maneuver> RecordManeuvers::validation_data() const { return without_names(validation); }

Result<RecordManeuvers> read_maneuvers(const RecordSelection& selection) {
  RecordManeuvers out;
  Channels channels;
  for (const std::string& file : selection.records) {
    Result<NamedManeuver> read = read_maneuver(file, selection, channels);
    if (!read) return fail(read.error());
    std::optional<NamedManeuver> end;
    if (selection.hold_back > 0.0) end = cut_end(*read, selection.hold_back);
    const Eigen::MatrixXd offset = remove_offsets(std::span<Maneuver>(&read->maneuver, 1), selection.offset);
    if (end) {
      const Eigen::Index n_u = end->maneuver.inputs.cols(), n_y = end->maneuver.outputs.cols();
      end->maneuver.inputs.rowwise() -= offset.row(0).head(n_u);
      end->maneuver.outputs.rowwise() -= offset.row(0).tail(n_y);
      out.validation.push_back(std::move(*end));
    }
    out.identification.push_back(std::move(*read));
  }
  for (const std::string& file : selection.validation) {
    Result<NamedManeuver> read = read_maneuver(file, selection, channels);
    if (!read) return fail(read.error());
    remove_offset(*read, selection.offset);
    out.validation.push_back(std::move(*read));
  }
  if (Status status = check_weights(selection, channels); !status) return fail(status.error());
  out.inputs = channels.inputs;
  out.outputs = channels.outputs;
  out.rate_hz = channels.rate_hz / selection.decimation;
  return out;
}

ManeuverScore score(const NamedManeuver& maneuver, const std::vector<std::string>& outputs,
                    const DiscreteModel& model, std::span<const double> weights) {
  ManeuverScore out;
  out.name = maneuver.name;
  const auto fit = fit_maneuver(model, maneuver.maneuver);
  if (!fit) {
    out.failure = fit.error().message;
    return out;
  }
  const Eigen::MatrixXd& measured = maneuver.maneuver.outputs;
  out.rms = rms_error(measured, fit->outputs);
  std::vector<double> agreements;
  for (Eigen::Index i = 0; i < measured.cols(); ++i) {
    const std::span<const double> m(measured.col(i).data(), static_cast<std::size_t>(measured.rows()));
    const std::span<const double> y(fit->outputs.col(i).data(), m.size());
    out.outputs.push_back(
        {outputs[static_cast<std::size_t>(i)], variance_accounted_for(measured.col(i), fit->outputs.col(i)),
         rms_error(measured.col(i), fit->outputs.col(i)), theil_coefficient(m, y), index_of_agreement(m, y)});
    if (out.outputs.back().agreement) agreements.push_back(*out.outputs.back().agreement);
  }
  if (agreements.size() == out.outputs.size())
    out.overall_agreement = overall_index_of_agreement(agreements, weights);
  out.simulated = fit->outputs;
  return out;
}

}  // namespace fatmc::cli
