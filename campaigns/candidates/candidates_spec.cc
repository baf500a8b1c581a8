#include "campaigns/candidates/candidates_spec.h"

#include <algorithm>
#include <cmath>

#include "campaigns/base/decoder.h"
#include "core/base/text.h"

namespace fatmc::candidates {
namespace {

Eigen::MatrixXd matrix(Decoder& table, const char* key, std::size_t rows, std::size_t columns) {
  const std::vector<std::vector<double>> values = table.matrix(key, rows, columns);
  Eigen::MatrixXd out(values.size(), columns);
  for (std::size_t i = 0; i < values.size(); ++i) {
    for (std::size_t j = 0; j < columns; ++j)
      out(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = values[i][j];
  }
  return out;
}

Status decode_truth(const Tree& tree, Truth& out) {
  Decoder table(tree, "model");
  table.choice("kind", {"state_space"});
  table.text("name", "");
  out.rate_hz = table.real("rate_hz", {.low = 1e-3, .high = 1e6});
  const Tree* a = tree.find("A");
  const std::size_t states = a != nullptr && a->array() != nullptr ? a->array()->items.size() : 0;
  const auto names = [&](const char* key, const std::vector<std::string>& wanted) {
    if (table.texts(key) != wanted && !table.error()) {
      std::string list;
      for (const std::string& name : wanted) list += (list.empty() ? "" : ", ") + name;
      table.reject(key, "the study needs these channels in this order: " + list);
    }
  };
  names("inputs", input_names());
  names("outputs", output_names());
  out.model.a = matrix(table, "A", states, states);
  out.model.b = matrix(table, "B", states, kInputs);
  out.model.c = matrix(table, "C", kOutputs, states);
  if (!table.error()) {
    const Eigen::MatrixXd speeds = out.model.c.topRows(3);
    if (states < 3 || speeds != Eigen::MatrixXd::Identity(3, static_cast<Eigen::Index>(states)))
      table.reject("C", "has to give u, v and w as the first three states: gusts act on them");
  }
  return table.finish();
}

Status decode_flight(const Tree& tree, FlightTest& out) {
  Decoder table(tree, "flight");
  constexpr RealRange percent{.low = 0.0, .high = 100.0};
  out.sweep_samples =
      static_cast<int>(table.integer("sweep_samples", {.low = 100, .high = 1000000}, out.sweep_samples));
  out.multistep_samples = static_cast<int>(
      table.integer("multistep_samples", {.low = 100, .high = 100000}, out.multistep_samples));
  out.sweep_amplitude_pct = table.reals("sweep_amplitude_pct", kInputs, percent);
  out.multistep_amplitude_pct = table.reals("multistep_amplitude_pct", kInputs, percent);
  out.sweep_low_hz = table.real("sweep_low_hz", {.low = 1e-3, .high = 10.0}, out.sweep_low_hz);
  out.sweep_high_hz = table.real("sweep_high_hz", {.low = 1e-3, .high = 10.0}, out.sweep_high_hz);
  if (!(out.sweep_high_hz > out.sweep_low_hz) && !table.error())
    table.reject("sweep_high_hz", "has to be above sweep_low_hz");
  out.multistep_unit_s = table.real("multistep_unit_s", {.low = 0.04, .high = 10.0}, out.multistep_unit_s);
  out.noise = table.reals("noise", kOutputs, {.low = 0.0, .high = 1e3});
  out.gust_m_s = table.real("gust_m_s", {.low = 0.0, .high = 20.0}, 0.0);
  out.gust_time_constant_s = table.real("gust_time_constant_s", {.low = 0.01, .high = 1e3}, 1.0);
  out.scas = table.real("scas", {.low = 0.0, .high = 2.0}, 0.0);
  return table.finish();
}

void decode_regularization(Decoder& table, Identification& out) {
  const std::string rule = table.choice("regularization", {"fixed", "gcv", "srgcv", "lcurve"}, "srgcv");
  out.regularization.lambda = table.real("lambda", {.low = 0.0, .high = 1e12}, 0.0);
  out.regularization.rule = rule == "fixed"   ? Regularization::fixed
                            : rule == "gcv"   ? Regularization::gcv
                            : rule == "srgcv" ? Regularization::srgcv
                                              : Regularization::lcurve;
  out.lambda_for_each_past = table.choice("lambda_of", {"past", "block"}, "past") == "past";
  out.final_regression = table.choice("final", {"paper", "residual"}, "paper") == "paper"
                             ? FinalRegression::paper
                             : FinalRegression::residual;
}

Status decode_identification(const Tree& tree, const FlightTest& flight, Identification& out) {
  Decoder table(tree, "identification");
  constexpr IntegerRange windows{.low = 1, .high = 100000};
  // H (4): sum N_j / (n_u + n_y + J), eight sweeps.
  const std::int64_t largest = 8 * flight.sweep_samples / (kInputs + kOutputs + 8);
  const std::int64_t low = table.integer("past_low", windows, 20),
                     step = table.integer("past_step", windows, 10),
                     high = table.integer("past_high", windows, largest);
  if (high < low && !table.error()) table.reject("past_high", "has to be past_low at least");
  if (high > largest && !table.error()) {
    table.reject("past_high", "has more unknowns than equations, the largest for these sweeps is " +
                                  std::to_string(largest));
  }
  for (std::int64_t past = low; past < high; past += step) out.pasts.push_back(static_cast<int>(past));
  out.pasts.push_back(static_cast<int>(high));
  std::reverse(out.pasts.begin(), out.pasts.end());
  out.block = static_cast<int>(table.integer("block", {.low = 1, .high = 1000}, out.block));
  out.lowest_order = static_cast<int>(table.integer("order_low", {.low = 1, .high = 100}, out.lowest_order));
  out.highest_order =
      static_cast<int>(table.integer("order_high", {.low = 1, .high = 100}, out.highest_order));
  if (out.highest_order < out.lowest_order && !table.error())
    table.reject("order_high", "has to be order_low at least");
  decode_regularization(table, out);
  return table.finish();
}

/// [validation] weights; 1 each without.
Status decode_weights(const Tree* tree, std::vector<double>& out) {
  out.assign(kOutputs, 1.0);
  if (tree == nullptr) return {};
  Decoder table(*tree, "validation");
  out = table.reals("weights", kOutputs, {.low = 0.0, .high = 100.0}, out);
  if (!table.error() && *std::max_element(out.begin(), out.end()) == 0.0)
    table.reject("weights", "at least one output has to count: give one a weight above 0");
  return table.finish();
}

Status decode_selection(const Tree& tree, const Identification& identification, Selection& out) {
  Decoder table(tree, "selection");
  out.order = static_cast<int>(
      table.integer("order", {.low = identification.lowest_order, .high = identification.highest_order}));
  const bool limit = table.has("norm"), quantile = table.has("smallest_norms");
  if (limit) out.norm = table.real("norm", {.low = 0.0, .high = 1e12});
  if (quantile) out.smallest_norms = table.real("smallest_norms", {.low = 1e-6, .high = 1.0});
  if (limit == quantile && !table.error()) table.reject("norm", "give either norm or smallest_norms");
  out.share = table.real("share", {.low = 0.0, .high = 1.0});
  return table.finish();
}

}  // namespace

const std::vector<std::string>& input_names() {
  static const std::vector<std::string> names = {"delta_x", "delta_y", "delta_p", "delta_0"};
  return names;
}

const std::vector<std::string>& output_names() {
  static const std::vector<std::string> names = {"u", "v", "w", "p", "q", "r", "phi", "theta"};
  return names;
}

std::size_t Identification::blocks() const {
  const auto size = static_cast<std::size_t>(block);
  return (pasts.size() + size - 1) / size;
}

std::vector<int> Identification::block_pasts(std::size_t index) const {
  const std::size_t size = static_cast<std::size_t>(block), first = std::min(index * size, pasts.size());
  const std::size_t last = std::min(first + size, pasts.size());
  return {pasts.begin() + static_cast<std::ptrdiff_t>(first),
          pasts.begin() + static_cast<std::ptrdiff_t>(last)};
}

std::string Selection::limit_text() const {
  return smallest_norms > 0.0 ? "smallest " + significant(100.0 * smallest_norms, 3) + " % of the norms"
                              : "norm below " + significant(norm, 3);
}

Result<CandidatesSpec> decode_candidates(const CampaignSpec& own) {
  Decoder top(own.tree, "");
  for (const char* key : {"campaign", "cell", "published"}) top.skip(key);
  const Tree* model = top.table("model");
  const Tree* flight = top.table("flight");
  const Tree* identification = top.table("identification");
  const Tree* validation = top.table("validation", false);
  const std::vector<const Tree*> selections = top.tables("selection");
  if (Status status = top.finish(); !status) return fail(status.error());
  Decoder cell(own.cells.front().tree, "cell");
  for (const char* key : {"name", "repetitions"}) cell.skip(key);
  cell.boolean("compare", true);
  if (Status status = cell.finish(); !status) return fail(status.error());
  CandidatesSpec out;
  if (Status status = decode_truth(*model, out.truth); !status) return fail(status.error());
  if (Status status = decode_flight(*flight, out.flight); !status) return fail(status.error());
  if (Status status = decode_identification(*identification, out.flight, out.identification); !status)
    return fail(status.error());
  if (Status status = decode_weights(validation, out.weights); !status) return fail(status.error());
  for (const Tree* entry : selections) {
    Selection selection;
    if (Status status = decode_selection(*entry, out.identification, selection); !status)
      return fail(status.error());
    out.selections.push_back(selection);
  }
  return out;
}

}  // namespace fatmc::candidates
