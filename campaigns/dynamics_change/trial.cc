#include "campaigns/dynamics_change/trial.h"

#include <cmath>
#include <limits>
#include <utility>

#include "campaigns/dynamics_change/change_cell.h"
#include "campaigns/dynamics_change/row_arrays.h"
#include "core/base/text.h"
#include "core/stability/stability_monitor.h"

namespace fatmc::dynamics_change {
namespace {

/// The plant that the monitor takes for granted: the model as it stands in the file.
Result<NominalLoop> nominal_of(const ChangeCell& cell, const LpmGrid& grid) {
  const FlightSetup& setup = cell.flown.experiment.flight;
  auto flight = prepare_flight(cell.flown.model, setup);
  if (!flight) return fail(flight.error());
  const LinearModel& map = flight->sampled();
  const std::optional<StabilisedModel> stable = stabilise({map.a, map.b, map.c, map.d});
  if (!stable) return fail("the linear model of the aircraft has no eigenvalues");
  std::vector<double> frequency_hz;
  for (int k = 0; k < grid.line_count(); ++k) frequency_hz.push_back(grid.frequency_hz(k));
  const Eigen::Matrix3d controller = setup.gain.asDiagonal();
  return nominal_loop(stable->model, controller, frequency_hz, setup.rate_hz);
}

/// Mean over the lines of ln C_V_noise,ii. Lines without a positive one have no estimate and are left out; NaN without any.
double noise_level(const FrmEstimate& estimate, int output) {
  double sum = 0.0;
  int lines = 0;
  for (int k = 0; k < estimate.line_count(); ++k) {
    const double variance = estimate.C_V_noise[k](output, output).real();
    if (!(variance > 0.0 && std::isfinite(variance))) continue;
    sum += std::log(variance);
    ++lines;
  }
  return lines > 0 ? sum / lines : std::numeric_limits<double>::quiet_NaN();
}

class ChangeTrials final : public PreparedCell {
 public:
  ChangeTrials(ChangeCell cell, LpmGrid grid, NominalLoop nominal, TrialSeed seed, TrialKey key)
      : cell_(std::move(cell)),
        grid_(std::move(grid)),
        nominal_(std::move(nominal)),
        seed_(seed),
        key_(key) {}

  TrialRow run(std::uint64_t repetition) const override {
    TrialRow row;
    row.key = {key_.cell, repetition};
    const std::vector<Effect> change = drawn_change(cell_, seed(repetition));
    FlightRecord record;
    if (!fly(repetition, change, record, row)) return row;
    describe(change, record, row);
    watch(record, row);
    return row;
  }

  std::optional<TrialRecord> record(std::uint64_t repetition) const override {
    TrialRow row;
    FlightRecord record;
    if (!fly(repetition, drawn_change(cell_, seed(repetition)), record, row)) return std::nullopt;
    return trial_record(record, cell_.flown.experiment, cell_.flown.model.aircraft);
  }

 private:
  [[nodiscard]] TrialSeed seed(std::uint64_t repetition) const {
    TrialSeed out = seed_;
    out.repetition = repetition;
    return out;
  }

  /// False where the drawn change gives no aircraft that flies.
  bool fly(std::uint64_t repetition, const std::vector<Effect>& change, FlightRecord& record,
           TrialRow& row) const {
    const Experiment& experiment = cell_.flown.experiment;
    auto flight = prepare_flight(cell_.flown.model, experiment.flight, change);
    if (!flight) {
      row.outcome = "no flight";
      row.detail = flight.error().text();
      return false;
    }
    flight->fly(reference_signal(experiment, seed(repetition)), seed(repetition), record);
    if (record.ending != Ending::completed) {
      row.outcome = "diverged";
      row.detail = std::string(name(record.ending)) + " at " + shortest(record.ending_time_s) + " s";
    }
    return true;
  }

  void describe(const std::vector<Effect>& change, const FlightRecord& record, TrialRow& row) const {
    const bool any = !change.empty();
    row.metrics = {
        {kEpoch, cell_.epoch_s},
        {kWindow, grid_.total_samples() / cell_.flown.experiment.flight.rate_hz},
        {kOnset, any ? change.front().onset->start_s : std::numeric_limits<double>::infinity()},
        {kDuration, cell_.duration_s},
        {kStrength, any ? change.front().values.front() : std::numeric_limits<double>::quiet_NaN()},
        {kFlown, record.ending_time_s}};
  }

  void watch(const FlightRecord& record, TrialRow& row) const {
    StabilityMonitor monitor(grid_, 3, nominal_, cell_.judgement);
    const auto every =
        static_cast<Eigen::Index>(std::llround(cell_.epoch_s * cell_.flown.experiment.flight.rate_hz));
    std::vector<double> csl, robust, nominally;
    std::array<std::vector<double>, 3> noise;
    std::array<double, 3> y, u, r;
    for (Eigen::Index t = 0; t < record.samples; ++t) {
      for (int i = 0; i < 3; ++i) {
        const auto c = static_cast<std::size_t>(i);
        y[c] = record.output(t, i);
        u[c] = record.input(t, i);
        r[c] = record.reference(t, i);
      }
      monitor.push(y, u, r);
      if ((t + 1) % every != 0) continue;
      const BandStability band = monitor.epoch().band;
      csl.push_back(band.p_total_ssv);
      robust.push_back(band.p_ssv);
      nominally.push_back(band.nominally_stable_ssv ? 1.0 : 0.0);
      for (int i = 0; i < 3; ++i)
        noise[static_cast<std::size_t>(i)].push_back(noise_level(monitor.estimate(), i));
    }
    row.arrays = {
        {kCslSsv, std::move(csl)}, {kRobustSsv, std::move(robust)}, {kNominal, std::move(nominally)}};
    for (std::size_t i = 0; i < 3; ++i) row.arrays.emplace_back(kNoise[i], std::move(noise[i]));
  }

  ChangeCell cell_;
  LpmGrid grid_;
  NominalLoop nominal_;
  TrialSeed seed_;
  TrialKey key_;
};

Result<std::unique_ptr<PreparedCell>> prepare(const CampaignSpec& spec, std::uint32_t index) {
  auto cell = decode_change_cell(spec, index);
  if (!cell) return fail(cell.error());
  const auto place = [&](const char* key, const Error& error) {
    const Tree* table = spec.tree.find(key);
    return table != nullptr ? Error{table->file, table->line, key, error.message} : error;
  };
  const Experiment& experiment = cell->flown.experiment;
  auto grid = LpmGrid::create({experiment.excitation.lines, experiment.excitation.period_samples,
                               cell->window_periods, experiment.flight.rate_hz},
                              cell->flown.estimator, 3);
  if (!grid) return fail(place("estimator", grid.error()));
  auto nominal = nominal_of(*cell, *grid);
  if (!nominal) return fail(place("model", nominal.error()));
  const TrialKey key{index, 0};
  return std::make_unique<ChangeTrials>(std::move(*cell), std::move(*grid), std::move(*nominal),
                                        spec.trial_seed(key), key);
}

}  // namespace

const TrialStudy kTrialStudy{"dynamics_change", &prepare};

}  // namespace fatmc::dynamics_change
