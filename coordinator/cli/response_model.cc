#include "coordinator/cli/response_model.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "campaigns/base/decoder.h"
#include "campaigns/base/trial_row.h"
#include "coordinator/input/record_file.h"
#include "coordinator/input/state_space_model.h"
#include "coordinator/input/toml_file.h"
#include "core/base/text.h"
#include "core/discrepancy/linear_prediction.h"
#include "core/signal/dft.h"

namespace fatmc::cli {
namespace {

namespace fs = std::filesystem;

const std::vector<std::string>& kinds() {
  static const std::vector<std::string> names = {"frf", "recorded_output", "state_space"};
  return names;
}

/// The keys of a frequency response and of a recorded output; of a state-space model band_hz alone.
Status decode_keys(const Tree& tree, ResponseModel& out, std::string& file) {
  Decoder top(tree, "");
  const std::string kind = top.choice("kind", kinds());
  out.kind = kind == "frf"           ? ResponseKind::frf
             : kind == "state_space" ? ResponseKind::state_space
                                     : ResponseKind::recorded_output;
  if (out.kind == ResponseKind::frf) {
    file = top.text("response");
    out.diagonal = top.choice("elements", {"all", "diagonal"}, "all") == "diagonal";
  } else if (out.kind == ResponseKind::recorded_output) {
    file = top.text("data");
    out.columns = top.texts("output");
  } else {
    for (const auto& [key, value] : tree.table()->entries) {
      if (key != "band_hz") top.skip(key);
    }
  }
  if (top.has("band_hz")) out.band_hz = top.reals("band_hz", 2, {.low = 0.0, .high = 1e6});
  if (!top.error() && !out.band_hz.empty() && out.band_hz[1] <= out.band_hz[0])
    top.reject("band_hz", "write a lower and a higher frequency");
  return top.finish();
}

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

/// First and last bin of the band.
struct BinRange {
  Eigen::Index first = 0, last = 0;
  [[nodiscard]] Eigen::Index count() const { return last - first + 1; }
};

Result<BinRange> bins_of(const ResponseModel& model, const Eigen::MatrixXcd& input, double bin_hz,
                         const std::string& path) {
  double low = bin_hz, high = input_band(input, bin_hz);
  if (model.kind == ResponseKind::frf) {
    low = std::max(low, model.response.frequency_hz.front());
    high = std::min(high, model.response.frequency_hz.back());
  }
  if (!model.band_hz.empty()) {
    low = std::max(low, model.band_hz[0]);
    high = model.band_hz[1];
  }
  const BinRange out{
      static_cast<Eigen::Index>(std::ceil(low / bin_hz - 1e-9)),
      std::min<Eigen::Index>(static_cast<Eigen::Index>(std::floor(high / bin_hz + 1e-9)), input.rows() - 1)};
  if (out.last <= out.first)
    return fail(Error{path, 0, "band_hz", "holds no bins of the record and the model"});
  return out;
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

/// What the model gave for the record, from its own file.
Status subtract_series(const ResponseModel& model, const Record& record, const std::string& path,
                       const BinRange& bins, ModelledSpectra& out) {
  if (model.columns.size() != out.outputs.size()) {
    return fail(Error{model.path, 0, "output",
                      "names " + std::to_string(model.columns.size()) + " columns, the record has " +
                          std::to_string(out.outputs.size()) + " outputs"});
  }
  if (model.series.values.rows() != record.sample_count()) {
    return fail(Error{model.path, 0, "data",
                      "has " + std::to_string(model.series.values.rows()) + " rows, the record " + path +
                          " has " + std::to_string(record.sample_count())});
  }
  Eigen::MatrixXd series(model.series.values.rows(), out.output.cols());
  for (std::size_t i = 0; i < model.columns.size(); ++i) {
    const auto at = std::find(model.series.names.begin(), model.series.names.end(), model.columns[i]);
    if (at == model.series.names.end())
      return fail(Error{model.path, 0, "output",
                        "names \"" + model.columns[i] + "\", the data have " + join(model.series.names)});
    series.col(static_cast<Eigen::Index>(i)) = model.series.values.col(at - model.series.names.begin());
  }
  out.error = out.output - transform(series).middleRows(bins.first, bins.count());
  return {};
}

Status subtract_response(const ResponseModel& model, const std::string& path, ModelledSpectra& out) {
  const auto place = [](const std::vector<std::string>& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) - names.begin();
  };
  out.response = model.response;
  for (std::size_t i = 0; i < out.outputs.size(); ++i) {
    for (std::size_t j = 0; j < out.inputs.size(); ++j) {
      const auto row = static_cast<Eigen::Index>(i), column = static_cast<Eigen::Index>(j);
      const auto a = place(model.response.outputs, out.outputs[i]),
                 b = place(model.response.inputs, out.inputs[j]);
      if (a == static_cast<std::ptrdiff_t>(model.response.outputs.size()) ||
          b == static_cast<std::ptrdiff_t>(model.response.inputs.size())) {
        return fail(
            Error{model.path, 0, "response",
                  "has no element " + out.outputs[i] + "/" + out.inputs[j] + " of the record " + path});
      }
      out.absent(row, column) = model.diagonal && i != j;
      if (out.absent(row, column)) continue;
      for (Eigen::Index m = 0; m < out.error.rows(); ++m)
        out.error(m, row) -=
            interpolated(model.response, out.frequency_hz[static_cast<std::size_t>(m)], a, b) *
            out.input(m, column);
    }
  }
  return {};
}

Status subtract_state_space(const ResponseModel& model, const Record& record, const std::string& path,
                            ModelledSpectra& out) {
  const RecordChannels channels{out.inputs, out.outputs, record.rate_hz, record.hold};
  const auto named = decode_state_space(model.state_space, channels);
  if (!named) return fail(named.error());
  const auto picked = pick_channels(*named, channels, model.path);
  if (!picked) return fail(picked.error());
  auto predicted =
      predict_linear(*picked, record.rate_hz, record.sample_count(), out.frequency_hz, out.input, out.output);
  if (!predicted) return fail(Error{path, 0, "", predicted.error().message});
  out.error = std::move(predicted->error);
  out.response = {out.outputs, out.inputs, out.frequency_hz, std::move(predicted->response)};
  out.absent.setConstant(true);
  for (int k = 0; k < out.response.response.count(); ++k)
    out.absent = out.absent.array() && (out.response.response[k].array() == 0.0);
  std::vector<std::string> unrecorded;
  for (const std::string& name : named->inputs) {
    if (std::find(out.inputs.begin(), out.inputs.end(), name) == out.inputs.end()) unrecorded.push_back(name);
  }
  if (!unrecorded.empty())
    out.notes.push_back("The record does not have the model's " + join(unrecorded) + ", taken as constant.");
  return {};
}

}  // namespace

std::string response_kind(const std::string& model) {
  const auto tree = read_toml(model);
  if (!tree) return "";
  const Tree* kind = tree->find("kind");
  const auto* text = kind != nullptr ? std::get_if<std::string>(&kind->value) : nullptr;
  return text != nullptr && std::find(kinds().begin(), kinds().end(), *text) != kinds().end() ? *text : "";
}

Result<ResponseModel> read_response_model(const std::string& path) {
  auto tree = read_toml(path);
  if (!tree) return fail(tree.error());
  ResponseModel out;
  out.path = path;
  std::string file;
  if (Status status = decode_keys(*tree, out, file); !status) return fail(status.error());
  const std::string data = (fs::path(path).parent_path() / file).string();
  if (out.kind == ResponseKind::recorded_output) {
    auto columns = read_columns(data);
    if (!columns) return fail(columns.error());
    out.series = std::move(*columns);
  } else if (out.kind == ResponseKind::frf) {
    auto table = read_response_table(data);
    if (!table) return fail(table.error());
    out.response = std::move(*table);
  } else {
    tree->erase("band_hz");
    out.state_space = std::move(*tree);
  }
  std::ifstream in(path, std::ios::binary);
  std::stringstream text;
  text << in.rdbuf();
  out.hash = hex(sha256(text.str()));
  return out;
}

Result<ModelledSpectra> modelled_spectra(const std::string& path, const ResponseModel& model) {
  const auto record = read_record(path);
  if (!record) return fail(record.error());
  ModelledSpectra out;
  for (const int c : record->input) out.inputs.push_back(record->names[static_cast<std::size_t>(c)]);
  for (const int c : record->output) out.outputs.push_back(record->names[static_cast<std::size_t>(c)]);
  const Eigen::MatrixXcd u = transform(record->channels(record->input)),
                         y = transform(record->channels(record->output));
  const double bin_hz = record->rate_hz / record->sample_count();
  const auto bins = bins_of(model, u, bin_hz, path);
  if (!bins) return fail(bins.error());
  for (Eigen::Index m = bins->first; m <= bins->last; ++m)
    out.frequency_hz.push_back(static_cast<double>(m) * bin_hz);
  out.input = u.middleRows(bins->first, bins->count());
  out.output = out.error = y.middleRows(bins->first, bins->count());
  out.absent.setConstant(out.output.cols(), out.input.cols(), false);
  Status status = model.kind == ResponseKind::recorded_output
                      ? subtract_series(model, *record, path, *bins, out)
                  : model.kind == ResponseKind::frf ? subtract_response(model, path, out)
                                                    : subtract_state_space(model, *record, path, out);
  if (!status) return fail(status.error());
  if (!record->reference.empty() && model.repairable())
    out.notes.push_back(
        "The record has references, so that its inputs may carry fed-back noise: of an element found, part "
        "may be the "
        "controller's answer to that noise.");
  return out;
}

}  // namespace fatmc::cli
