#include "campaigns/coverage/trial.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <optional>

#include "campaigns/base/experiment.h"
#include "campaigns/coverage/coverage_cell.h"
#include "campaigns/coverage/row_arrays.h"
#include "core/ident/fast_lpm.h"
#include "core/ident/interpolation_bias.h"
#include "core/stats/confidence.h"

namespace fatmc::coverage {
namespace {

constexpr int kAxes = 3;
constexpr const char* kInputSuffix[] = {"xi_c", "eta_c", "zeta_c"};
constexpr const char* kServoSuffix[] = {"aileron", "left_ruddervator", "right_ruddervator"};

// Workspace of one trial; large enough to be worth keeping from trial to trial.
struct Workspace {
  explicit Workspace(const LpmGrid& grid) : estimator(grid, kAxes) {}
  FlightRecord record;
  FastLpm estimator;
};

class CoverageTrials final : public PreparedCell {
 public:
  CoverageTrials(CoverageCell cell, Flight flight, LpmGrid grid, TrialSeed seed, TrialKey key)
      : cell_(std::move(cell)), flight_(std::move(flight)), grid_(std::move(grid)), seed_(seed), key_(key) {
    for (int k = 0; k < grid_.line_count(); ++k)
      truth_.push_back(flight_.sampled().response(grid_.frequency_hz(k)));
  }

  TrialRow run(std::uint64_t repetition) const override {
    TrialRow row;
    row.key = {key_.cell, repetition};
    TrialSeed seed = seed_;
    seed.repetition = repetition;
    std::unique_ptr<Workspace> workspace = take_workspace();
    FlightRecord& record = workspace->record;
    flight_.fly(reference_signal(cell_.experiment, seed), seed, record);
    if (record.ending == Ending::completed) {
      estimate(*workspace, row);
    } else {
      row.outcome = "diverged";
      row.detail = std::string(name(record.ending)) + " at " + std::to_string(record.ending_time_s) + " s";
    }
    describe_flight(record, row);
    give_back(std::move(workspace));
    return row;
  }

  std::optional<TrialRecord> record(std::uint64_t repetition) const override {
    TrialSeed seed = seed_;
    seed.repetition = repetition;
    std::unique_ptr<Workspace> workspace = take_workspace();
    flight_.fly(reference_signal(cell_.experiment, seed), seed, workspace->record);
    TrialRecord out = trial_record(workspace->record, cell_.experiment, flight_.aircraft());
    give_back(std::move(workspace));
    return out;
  }

 private:
  // Trials of one cell run in several threads at once; each takes a workspace that no other has.
  std::unique_ptr<Workspace> take_workspace() const {
    const std::lock_guard lock(mutex_);
    if (idle_.empty()) return std::make_unique<Workspace>(grid_);
    std::unique_ptr<Workspace> out = std::move(idle_.back());
    idle_.pop_back();
    return out;
  }
  void give_back(std::unique_ptr<Workspace> workspace) const {
    const std::lock_guard lock(mutex_);
    idle_.push_back(std::move(workspace));
  }

  void estimate(Workspace& workspace, TrialRow& row) const {
    const FlightRecord& record = workspace.record;
    workspace.estimator.load(record.output, record.input);
    FrmEstimate frm = workspace.estimator.indirect(spectra_at_lines(grid_, record.reference));
    for (const LineStatus status : frm.status) {
      if (status == LineStatus::ok) continue;
      row.outcome = "singular";
      row.detail = status == LineStatus::singular_input ? "G_ur has no inverse"
                                                        : "the references do not span all inputs";
      return;
    }
    const double mean_speed = record.auxiliary.col(2).mean();
    // (3.4): the response grows with airspeed; refer it to the trim speed.
    if (cell_.speed_correction) scale_response(frm, flight_.aircraft().speed_m_s / mean_speed);
    const MatrixStack<double> bias = interpolation_bias(grid_, frm, BiasConstant::exact_offsets);
    std::optional<MatrixStack<double>> printed;  // print has constants for the orders 2, 4 and 6
    if (printed_bias_constant(cell_.estimator.order)) {
      printed = interpolation_bias(grid_, frm, BiasConstant::printed);
    }
    store(frm, bias, printed, row);
    row.metrics.emplace_back("mean_speed_m_s", mean_speed);
  }

  void store(const FrmEstimate& frm, const MatrixStack<double>& bias,
             const std::optional<MatrixStack<double>>& printed, TrialRow& row) const {
    std::vector<double> re, im, variance, b, b_printed, snr;
    const double quantile = f_quantile_2_2q(0.95, frm.q);
    std::size_t inside = 0, inside_extended = 0;
    for (int k = 0; k < frm.line_count(); ++k) {
      for (int i = 0; i < kAxes; ++i) {
        for (int j = 0; j < kAxes; ++j) {
          const std::complex<double> error = frm.G[k](i, j) - truth_[static_cast<std::size_t>(k)](i, j);
          re.push_back(error.real());
          im.push_back(error.imag());
          variance.push_back(frm.variance(k, i, j));
          b.push_back(bias[k](i, j));
          const double limit = quantile * frm.variance(k, i, j);
          const double beyond = std::max(0.0, std::abs(error) - bias[k](i, j));
          inside += std::norm(error) <= limit ? 1 : 0;
          inside_extended += beyond * beyond <= limit ? 1 : 0;
          if (printed) b_printed.push_back((*printed)[k](i, j));
        }
      }
      for (int j = 0; j < kAxes; ++j)
        snr.push_back(20.0 * std::log10(std::max(frm.input_snr[k](j, 0), 1e-15)));
    }
    row.metrics.emplace_back(kDegreesOfFreedom, frm.q);
    row.metrics.emplace_back(kElements, kAxes * kAxes);
    row.metrics.emplace_back(kInputs, kAxes);
    row.metrics.emplace_back(kInside95, static_cast<double>(inside) / static_cast<double>(re.size()));
    row.metrics.emplace_back(kInsideExtended95,
                             static_cast<double>(inside_extended) / static_cast<double>(re.size()));
    for (int j = 0; j < kAxes; ++j) {
      double low = std::numeric_limits<double>::infinity();
      for (std::size_t k = 0; k < snr.size(); k += kAxes)
        low = std::min(low, snr[k + static_cast<std::size_t>(j)]);
      row.metrics.emplace_back(std::string("smallest_input_snr_db_") + kInputSuffix[j], low);
    }
    row.arrays.emplace_back(kErrorReal, std::move(re));
    row.arrays.emplace_back(kErrorImag, std::move(im));
    row.arrays.emplace_back(kVariance, std::move(variance));
    row.arrays.emplace_back(kBias, std::move(b));
    if (printed) row.arrays.emplace_back(kBiasPrinted, std::move(b_printed));
    row.arrays.emplace_back(kInputSnr, std::move(snr));
  }

  void describe_flight(const FlightRecord& record, TrialRow& row) const {
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

  CoverageCell cell_;
  Flight flight_;
  LpmGrid grid_;
  TrialSeed seed_;
  TrialKey key_;
  std::vector<Eigen::Matrix3cd> truth_;  // G0 at the lines
  mutable std::mutex mutex_;
  mutable std::vector<std::unique_ptr<Workspace>> idle_;
};

Result<std::unique_ptr<PreparedCell>> prepare(const CampaignSpec& spec, std::uint32_t index) {
  auto cell = decode_cell(spec, index);
  if (!cell) return fail(cell.error());
  const auto place = [&](const char* key, const Error& error) {
    const Tree* table = spec.tree.find(key);
    return table != nullptr ? Error{table->file, table->line, key, error.message} : error;
  };
  auto flight = Flight::prepare(cell->aircraft, cell->experiment.flight);
  if (!flight) {
    Error error =
        locate_flight_error(flight.error(), *spec.tree.find("model"), *spec.tree.find("experiment"));
    // The cell may have put another value in the experiment's place.
    const std::string key = error.key.substr(error.key.rfind('.') + 1);
    if (const Tree* own = spec.cells.at(index).tree.find(key))
      error = {own->file, own->line, "cell." + key, error.message};
    return fail(std::move(error));
  }
  const Excitation& excitation = cell->experiment.excitation;
  auto grid = LpmGrid::create(
      {excitation.lines, excitation.period_samples, excitation.periods, cell->experiment.flight.rate_hz},
      cell->estimator, kAxes);
  if (!grid) return fail(place("estimator", grid.error()));
  const TrialKey key{index, 0};
  return std::make_unique<CoverageTrials>(std::move(*cell), std::move(*flight), std::move(*grid),
                                          spec.trial_seed(key), key);
}

}  // namespace

const TrialStudy kTrialStudy{"coverage", &prepare};

}  // namespace fatmc::coverage
