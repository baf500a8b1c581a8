#include "campaigns/estimators/trial.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "campaigns/estimators/row_arrays.h"
#include "campaigns/flown/flown_cell.h"
#include "campaigns/flown/flown_flights.h"
#include "core/accuracy/response_accuracy.h"
#include "core/ident/estimators.h"
#include "core/stats/confidence.h"

namespace fatmc::estimators {
namespace {

constexpr std::array kMethods = {EstimationMethod::etfe, EstimationMethod::tlpm, EstimationMethod::lpm,
                                 EstimationMethod::lpm};
/// The reference cancels from the ratios of ETFE and tLPM.
constexpr std::array kIndirect = {true, true, false, true};
static_assert(kMethods.size() == kEstimators.size() && kIndirect.size() == kEstimators.size());

class EstimatorTrials final : public PreparedCell {
 public:
  EstimatorTrials(FlownCell cell, Flight flight, int axis, TrialSeed seed, TrialKey key)
      : cell_(std::move(cell)), flight_(std::move(flight)), axis_(axis), seed_(seed), key_(key) {
    for (const int line : cell_.experiment.excitation.lines) {
      frequency_hz_.push_back(line / cell_.experiment.excitation.period_s);
      truth_.push_back(flight_.sampled().response(frequency_hz_.back())(axis_, axis_));
    }
  }

  TrialRow run(std::uint64_t repetition) const override {
    TrialRow row;
    row.key = {key_.cell, repetition};
    FlightRecord record;
    fly(repetition, record);
    if (record.ending == Ending::completed) {
      estimate_all(record, row);
    } else {
      row.outcome = "diverged";
      row.detail = std::string(name(record.ending)) + " at " + std::to_string(record.ending_time_s) + " s";
    }
    FlownFlights::describe(record, row);
    return row;
  }

  std::optional<TrialRecord> record(std::uint64_t repetition) const override {
    FlightRecord flown;
    fly(repetition, flown);
    return trial_record(flown, cell_.experiment, cell_.model.aircraft);
  }

 private:
  void fly(std::uint64_t repetition, FlightRecord& record) const {
    TrialSeed trial = seed_;
    trial.repetition = repetition;
    flight_.fly(reference_signal(cell_.experiment, trial), trial, record);
  }

  [[nodiscard]] Measurement measurement(const FlightRecord& record, bool indirect) const {
    const Excitation& excitation = cell_.experiment.excitation;
    Measurement out;
    out.experiment = {excitation.lines, excitation.period_samples, excitation.periods,
                      cell_.experiment.flight.rate_hz};
    out.outputs = record.output.col(axis_);
    out.inputs = record.input.col(axis_);
    out.references.resize(record.reference.rows(), indirect ? 1 : 0);
    if (indirect) out.references.col(0) = record.reference.col(axis_);
    return out;
  }

  void estimate_all(const FlightRecord& record, TrialRow& row) const {
    const double mean_speed = record.auxiliary.col(2).mean();
    const double correction =
        cell_.speed_correction ? cell_.model.aircraft.speed_m_s / mean_speed : 1.0;  // (3.4)
    EstimatorOptions options;
    options.n_e = cell_.estimator.n_e;
    options.order = cell_.estimator.order;
    options.n_transient = cell_.estimator.n_transient;
    row.arrays.emplace_back(kFrequency, frequency_hz_);
    row.metrics.emplace_back("mean_speed_m_s", mean_speed);
    for (std::size_t e = 0; e < kEstimators.size(); ++e) {
      const Measurement m = measurement(record, kIndirect[e]);
      Result<ResponseEstimate> estimate = estimate_response(kMethods[e], {&m, 1}, options);
      if (!estimate) return fail_row(kEstimators[e], estimate.error().message, row);
      for (const LineStatus status : estimate->frm.status) {
        if (status != LineStatus::ok) return fail_row(kEstimators[e], "a line has no estimate", row);
      }
      scale_response(estimate->frm, correction);
      store(kEstimators[e], estimate->frm, row);
    }
  }

  static void fail_row(const Estimator& estimator, const std::string& why, TrialRow& row) {
    row.outcome = "singular";
    row.detail = std::string(estimator.label) + ": " + why;
    row.arrays.clear();
    row.metrics.clear();
  }

  void store(const Estimator& estimator, const FrmEstimate& frm, TrialRow& row) const {
    std::vector<double> re, im, variance;
    std::vector<ResponseError> errors;
    std::size_t inside = 0, unnoticed_lines = 0;
    double square = 0.0;
    const double quantile = f_quantile_2_2q(0.9, frm.q);
    for (std::size_t k = 0; k < truth_.size(); ++k) {
      const int line = static_cast<int>(k);
      const std::complex<double> relative = frm.G[line](0, 0) / truth_[k] - 1.0;
      re.push_back(relative.real());
      im.push_back(relative.imag());
      variance.push_back(frm.variance(line, 0, 0) / std::norm(truth_[k]));
      square += std::norm(relative);
      inside += std::norm(relative) <= quantile * variance.back() ? 1 : 0;
      const auto error = response_error(frm.G[line](0, 0), truth_[k]);
      if (!error) continue;  // an estimate of zero is outside any limit
      errors.push_back(*error);
      unnoticed_lines += unnoticed(*error, frequency_hz_[k]) ? 1 : 0;
    }
    const auto lines = static_cast<double>(truth_.size());
    row.metrics.emplace_back(name_of(estimator, kDegreesOfFreedom), frm.q);
    row.metrics.emplace_back(name_of(estimator, kInside90), static_cast<double>(inside) / lines);
    row.metrics.emplace_back(name_of(estimator, kUnnoticed), static_cast<double>(unnoticed_lines) / lines);
    row.metrics.emplace_back(name_of(estimator, kRelativeError), std::sqrt(square / lines));
    if (errors.size() == truth_.size())
      row.metrics.emplace_back(name_of(estimator, kCost), response_cost(errors));
    row.arrays.emplace_back(name_of(estimator, kErrorReal), std::move(re));
    row.arrays.emplace_back(name_of(estimator, kErrorImag), std::move(im));
    row.arrays.emplace_back(name_of(estimator, kVariance), std::move(variance));
  }

  FlownCell cell_;
  Flight flight_;
  int axis_;
  TrialSeed seed_;
  TrialKey key_;
  std::vector<double> frequency_hz_;
  std::vector<std::complex<double>> truth_;
};

/// The axis that is excited, or -1 where there is none or more than one.
int excited_axis(const Excitation& excitation) {
  int axis = -1;
  for (int i = 0; i < 3; ++i) {
    if (!(excitation.amplitude_rad_s[static_cast<std::size_t>(i)] > 0.0)) continue;
    if (axis >= 0) return -1;
    axis = i;
  }
  return axis;
}

Result<std::unique_ptr<PreparedCell>> prepare(const CampaignSpec& spec, std::uint32_t index) {
  static constexpr std::array kOwnKeys = {"label", "shows"};
  auto cell = decode_flown_cell(spec, index, {}, kOwnKeys);
  if (!cell) return fail(cell.error());
  const auto place = [&](const char* table, const std::string& key, const std::string& message) {
    const Tree* tree = spec.tree.find(table);
    const Tree& at = tree != nullptr ? *tree : spec.tree;
    return Error{at.file, at.line, std::string(table) + "." + key, message};
  };
  const int axis = excited_axis(cell->experiment.excitation);
  if (axis < 0) {
    return fail(place("experiment", "excitation.amplitude_rad_s",
                      "excites none or several axes; ETFE and tLPM have one input: leave one above zero"));
  }
  const Excitation& excitation = cell->experiment.excitation;
  if (const auto grid = LpmGrid::create(
          {excitation.lines, excitation.period_samples, excitation.periods, cell->experiment.flight.rate_hz},
          cell->estimator, 1);
      !grid) {
    return fail(place("estimator", grid.error().key, grid.error().message));
  }
  auto flight = prepare_flight(cell->model, cell->experiment.flight);
  if (!flight) {
    return fail(locate_flight_error(flight.error(), *spec.tree.find("model"), *spec.tree.find("experiment")));
  }
  const TrialKey key{index, 0};
  return std::make_unique<EstimatorTrials>(std::move(*cell), std::move(*flight), axis, spec.trial_seed(key),
                                           key);
}

}  // namespace

const TrialStudy kTrialStudy{"estimators", &prepare};

}  // namespace fatmc::estimators
