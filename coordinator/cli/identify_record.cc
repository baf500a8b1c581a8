#include "coordinator/cli/identify_record.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "coordinator/cli/estimate_record.h"
#include "coordinator/input/record_file.h"
#include "core/accuracy/series_accuracy.h"
#include "core/base/text.h"
#include "core/signal/decimate.h"

namespace fatmc::cli {
namespace {

struct NamedManeuver {
  std::string name;
  Maneuver maneuver;
};

/// Channels and rate of the first record; all others have to agree with it.
struct Channels {
  std::vector<std::string> inputs, outputs;
  double rate_hz = 0.0;
};

Result<NamedManeuver> read_maneuver(const std::string& file, const IdentifyArguments& arguments,
                                    Channels& channels) {
  Result<Record> record = read_record(file, arguments.meta);
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
  if (record->sample_count() <= 10 * arguments.decimation) {
    return fail(
        Error{file, 0, "--decimate",
              "the record has too few samples for a factor of " + std::to_string(arguments.decimation)});
  }
  return NamedManeuver{std::filesystem::path(file).filename().string(),
                       {decimate(record->channels(record->input), arguments.decimation),
                        decimate(record->channels(record->output), arguments.decimation)}};
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

ManeuverScore score(const NamedManeuver& maneuver, const std::vector<std::string>& outputs,
                    const DiscreteModel& model) {
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
  if (agreements.size() == out.outputs.size()) out.overall_agreement = overall_index_of_agreement(agreements);
  return out;
}

struct Maneuvers {
  std::vector<NamedManeuver> identification, validation;
  Channels channels;
};

void remove_offset(NamedManeuver& maneuver, OffsetRemoval rule) {
  remove_offsets(std::span<Maneuver>(&maneuver.maneuver, 1), rule);
}

Result<Maneuvers> read_maneuvers(const IdentifyArguments& arguments) {
  Maneuvers out;
  for (const std::string& file : arguments.records) {
    Result<NamedManeuver> read = read_maneuver(file, arguments, out.channels);
    if (!read) return fail(read.error());
    std::optional<NamedManeuver> end;
    if (arguments.hold_back > 0.0) end = cut_end(*read, arguments.hold_back);
    const Eigen::MatrixXd offset = remove_offsets(std::span<Maneuver>(&read->maneuver, 1), arguments.offset);
    if (end) {
      const Eigen::Index n_u = end->maneuver.inputs.cols(), n_y = end->maneuver.outputs.cols();
      end->maneuver.inputs.rowwise() -= offset.row(0).head(n_u);
      end->maneuver.outputs.rowwise() -= offset.row(0).tail(n_y);
      out.validation.push_back(std::move(*end));
    }
    out.identification.push_back(std::move(*read));
  }
  for (const std::string& file : arguments.validation) {
    Result<NamedManeuver> read = read_maneuver(file, arguments, out.channels);
    if (!read) return fail(read.error());
    remove_offset(*read, arguments.offset);
    out.validation.push_back(std::move(*read));
  }
  return out;
}

}  // namespace

Result<IdentifiedRecords> identify_records(const IdentifyArguments& arguments) {
  auto maneuvers = read_maneuvers(arguments);
  if (!maneuvers) return fail(maneuvers.error());
  std::vector<Maneuver> data;
  IdentifiedRecords out;
  for (const NamedManeuver& maneuver : maneuvers->identification) {
    data.push_back(maneuver.maneuver);
    out.samples += maneuver.maneuver.samples();
  }
  out.inputs = maneuvers->channels.inputs;
  out.outputs = maneuvers->channels.outputs;
  out.rate_hz = maneuvers->channels.rate_hz / arguments.decimation;
  auto model = identify_pbsid(data, arguments.pbsid);
  if (!model) return fail(Error{arguments.records.front(), 0, "identify", model.error().message});
  out.model = std::move(*model);
  const DiscreteModel discrete{out.model.a, out.model.b, out.model.c};
  auto continuous = continuous_model(discrete, 1.0 / out.rate_hz, arguments.continuation);
  if (continuous) {
    out.continuous = std::move(*continuous);
  } else {
    out.continuous_failure = continuous.error().message;
  }
  for (const NamedManeuver& maneuver : maneuvers->identification) {
    out.identification.push_back(score(maneuver, out.outputs, discrete));
  }
  for (const NamedManeuver& maneuver : maneuvers->validation) {
    out.validation.push_back(score(maneuver, out.outputs, discrete));
  }
  return out;
}

}  // namespace fatmc::cli
