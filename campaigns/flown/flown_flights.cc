#include "campaigns/flown/flown_flights.h"

#include <utility>

namespace fatmc {
namespace {

constexpr int kAxes = 3;
constexpr const char* kInputSuffix[] = {"xi_c", "eta_c", "zeta_c"};
constexpr const char* kServoSuffix[] = {"aileron", "left_ruddervator", "right_ruddervator"};

}  // namespace

FlownFlights::FlownFlights(FlownCell cell, Flight flight, LpmGrid grid, TrialSeed seed, TrialKey key)
    : cell_(std::move(cell)), flight_(std::move(flight)), grid_(std::move(grid)), seed_(seed), key_(key) {
  for (int k = 0; k < grid_.line_count(); ++k)
    truth_.push_back(flight_.sampled().response(grid_.frequency_hz(k)));
}

Result<std::unique_ptr<const FlownFlights>> FlownFlights::prepare(const CampaignSpec& spec,
                                                                  std::uint32_t index, FlownCell cell) {
  const auto place = [&](const char* key, const Error& error) {
    const Tree* table = spec.tree.find(key);
    return table != nullptr ? Error{table->file, table->line, key, error.message} : error;
  };
  auto flight = prepare_flight(cell.model, cell.experiment.flight);
  if (!flight) {
    Error error =
        locate_flight_error(flight.error(), *spec.tree.find("model"), *spec.tree.find("experiment"));
    // The cell may have put another value in the experiment's place.
    const std::string key = error.key.substr(error.key.rfind('.') + 1);
    if (const Tree* own = spec.cells.at(index).tree.find(key))
      error = {own->file, own->line, "cell." + key, error.message};
    return fail(std::move(error));
  }
  const Excitation& excitation = cell.experiment.excitation;
  auto grid = LpmGrid::create(
      {excitation.lines, excitation.period_samples, excitation.periods, cell.experiment.flight.rate_hz},
      cell.estimator, kAxes);
  if (!grid) return fail(place("estimator", grid.error()));
  const TrialKey key{index, 0};
  return std::unique_ptr<const FlownFlights>(
      new FlownFlights(std::move(cell), std::move(*flight), std::move(*grid), spec.trial_seed(key), key));
}

FlownFlights::Lease FlownFlights::borrow() const {
  const std::lock_guard lock(mutex_);
  if (idle_.empty()) return {*this, std::make_unique<Workspace>(grid_)};
  std::unique_ptr<Workspace> out = std::move(idle_.back());
  idle_.pop_back();
  return {*this, std::move(out)};
}

void FlownFlights::give_back(std::unique_ptr<Workspace> workspace) const {
  const std::lock_guard lock(mutex_);
  idle_.push_back(std::move(workspace));
}

TrialSeed FlownFlights::seed(std::uint64_t repetition) const {
  TrialSeed out = seed_;
  out.repetition = repetition;
  return out;
}

bool FlownFlights::fly(std::uint64_t repetition, Workspace& workspace, TrialRow& row) const {
  const TrialSeed trial = seed(repetition);
  FlightRecord& record = workspace.record;
  flight_.fly(reference_signal(cell_.experiment, trial), trial, record);
  if (record.ending == Ending::completed) return true;
  row.outcome = "diverged";
  row.detail = std::string(name(record.ending)) + " at " + std::to_string(record.ending_time_s) + " s";
  return false;
}

const FrmEstimate* FlownFlights::estimate(Workspace& workspace, TrialRow& row) const {
  const FlightRecord& record = workspace.record;
  workspace.estimator.load(record.output, record.input);
  workspace.corrected = workspace.estimator.indirect(spectra_at_lines(grid_, record.reference));
  FrmEstimate& frm = workspace.corrected;
  for (const LineStatus status : frm.status) {
    if (status == LineStatus::ok) continue;
    row.outcome = "singular";
    row.detail = status == LineStatus::singular_input ? "G_ur has no inverse"
                                                      : "the references do not span all inputs";
    return nullptr;
  }
  // (3.4): the response grows with airspeed; refer it to the trim speed.
  if (cell_.speed_correction)
    scale_response(frm, cell_.model.aircraft.speed_m_s / record.auxiliary.col(2).mean());
  return &frm;
}

void FlownFlights::describe(const FlightRecord& record, TrialRow& row) {
  for (int axis = 0; axis < kAxes; ++axis) {
    row.metrics.emplace_back(std::string("input_rms_") + kInputSuffix[axis], record.input_rms(axis));
    row.metrics.emplace_back(std::string("share_at_position_limit_") + kServoSuffix[axis],
                             record.at_position_limit(axis));
    row.metrics.emplace_back(std::string("share_at_rate_limit_") + kServoSuffix[axis],
                             record.at_rate_limit(axis));
  }
  const auto flown = record.auxiliary.topRows(record.samples);
  if (record.samples > 0) {
    row.metrics.emplace_back("largest_bank_rad", flown.col(0).cwiseAbs().maxCoeff());
    row.metrics.emplace_back("largest_pitch_rad", flown.col(1).cwiseAbs().maxCoeff());
  }
}

TrialRecord FlownFlights::record(std::uint64_t repetition) const {
  const Lease workspace = borrow();
  const TrialSeed trial = seed(repetition);
  flight_.fly(reference_signal(cell_.experiment, trial), trial, workspace->record);
  return trial_record(workspace->record, cell_.experiment, cell_.model.aircraft);
}

}  // namespace fatmc
