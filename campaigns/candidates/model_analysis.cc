#include "campaigns/candidates/model_analysis.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <utility>

#include "campaigns/candidates/candidates_spec.h"
#include "core/handling/control_loop.h"
#include "core/handling/requirements.h"
#include "core/stats/empirical.h"
#include "core/subspace/eigenvalues.h"

namespace fatmc::candidates {
namespace {

constexpr double kFeet = 1.0 / 0.3048, kDegrees = 180.0 / std::numbers::pi;

/// H (9): velocities in ft/s, rates in deg/s, attitudes in deg.
Eigen::RowVectorXd rms_units() {
  Eigen::RowVectorXd out(kOutputs);
  out << kFeet, kFeet, kFeet, kDegrees, kDegrees, kDegrees, kDegrees, kDegrees;
  return out;
}

/// Oscillatory modes in which that angular rate is the largest of the three; all for -1.
Result<std::vector<Mode>> modes_of_rate(const ContinuousModel& vehicle, int rate) {
  const auto pairs = eigenpairs_of(vehicle.a);
  if (!pairs) return fail("A is not finite");
  std::vector<Mode> out;
  for (Eigen::Index i = 0; i < pairs->values.size(); ++i) {
    if (!(pairs->values(i).imag() > 0.0)) continue;
    Eigen::Index largest = 0;
    (vehicle.c.middleRows<3>(kRollRate).cast<std::complex<double>>() * pairs->vectors.col(i))
        .cwiseAbs()
        .maxCoeff(&largest);
    if (rate < 0 || kRollRate + largest == rate) out.push_back({pairs->values(i)});
  }
  return out;
}

}  // namespace

double frequency_rad_s(int index) {
  constexpr double low = 0.1, high = 35.0;
  return low * std::pow(high / low, static_cast<double>(index) / (kFrequencies - 1));
}

const std::vector<double>& study_frequencies() {
  static const std::vector<double> values = [] {
    std::vector<double> out;
    for (int k = 0; k < kFrequencies; ++k) out.push_back(frequency_rad_s(k));
    return out;
  }();
  return values;
}

Result<Validation> validate(const ModalModel& modal, std::span<const Maneuver> maneuvers,
                            std::span<const double> weights) {
  const auto simulated = repeated_outputs(modal, maneuvers);
  if (!simulated) return fail(simulated.error());
  const Eigen::MatrixXd measured = stacked_outputs(maneuvers);
  auto overall = overall_accuracy(measured, *simulated, rms_units(), weights);
  if (!overall) return fail(overall.error());
  Validation out;
  out.overall = std::move(*overall);
  if (maneuvers.size() > kRollManeuver) {
    const Eigen::Index first = stacked_outputs(maneuvers.first(kRollManeuver)).rows(),
                       count = maneuvers[kRollManeuver].samples();
    const auto roll = overall_accuracy(measured.block(first, kRollRate, count, 1),
                                       simulated->block(first, kRollRate, count, 1),
                                       Eigen::RowVectorXd::Constant(1, kDegrees));
    if (!roll) return fail(roll.error());
    out.roll_agreement = roll->agreement;
    out.roll_rms = roll->rms;
  }
  return out;
}

Result<TruthResponse> truth_response(const DiscreteModel& truth, double rate_hz) {
  auto bare = continuous_model(truth, 1.0 / rate_hz, Continuation::zoh);
  if (!bare) return fail(bare.error());
  TruthResponse out;
  out.magnitude_db = roll_magnitude_db(*bare, study_frequencies());
  out.bare = std::move(*bare);
  return out;
}

int count_artifacts(const ContinuousModel& bare, std::span<const Mode> modes,
                    std::span<const double> magnitude_db, const TruthResponse& truth) {
  std::vector<double> difference;
  for (std::size_t k = 0; k < magnitude_db.size() && study_frequencies()[k] <= kArtifactRad_s; ++k)
    difference.push_back(magnitude_db[k] - truth.magnitude_db[k]);
  const double level = sample_quantile(difference, 0.5);
  int count = 0;
  for (const Mode& mode : modes) {
    const double w = mode.s.imag();
    if (!(w >= study_frequencies().front() && w < kArtifactRad_s)) continue;
    const double excess =
        roll_magnitude_db(bare, {&w, 1}).front() - roll_magnitude_db(truth.bare, {&w, 1}).front() - level;
    if (excess > kArtifact_db) ++count;
  }
  return count;
}

std::vector<double> roll_magnitude_db(const ContinuousModel& model, std::span<const double> rad_s) {
  const Eigen::Index n = model.a.rows();
  std::vector<double> out;
  for (const double w : rad_s) {
    const std::complex<double> s(0.0, w);
    const Eigen::MatrixXcd shifted = s * Eigen::MatrixXcd::Identity(n, n) - model.a;
    const Eigen::VectorXcd x = Eigen::PartialPivLU<Eigen::MatrixXcd>(shifted).solve(
        model.b.col(kLateralInput).cast<std::complex<double>>());
    const std::complex<double> g =
        (model.c.row(kRollRate).cast<std::complex<double>>() * x).value() * kDegrees;
    out.push_back(20.0 * std::log10(std::max(std::abs(g), 1e-12)));
  }
  return out;
}

Result<ModelAnalysis> analyse(const ContinuousModel& bare, std::span<const double> magnitude_db,
                              const TruthResponse& truth) {
  const std::array<ContinuousModel, 3> vehicles = {bare, stabilized_vehicle(bare), optimized_vehicle(bare)};
  const auto bare_modes = modes_of(bare.a);
  if (!bare_modes) return fail(bare_modes.error());
  ModelAnalysis out;
  for (std::size_t i = 0; i < kTrackedModes.size(); ++i) {
    const TrackedMode& wanted = kTrackedModes[i];
    const auto modes = modes_of_rate(vehicles[static_cast<std::size_t>(wanted.vehicle)], wanted.rate);
    if (!modes) return fail(modes.error());
    const auto mode = nearest_mode(*modes, mode_of(wanted.period_s, wanted.damping), kTrackedNear);
    if (!mode) continue;
    out.period_s[i] = mode->period_s();
    out.damping[i] = mode->damping();
  }
  for (std::size_t i = 0; i < kJudged.size(); ++i) {
    const JudgedResponse& judged = kJudged[i];
    const auto shares =
        mode_shares(vehicles[static_cast<std::size_t>(judged.vehicle)], judged.output, judged.input);
    if (!shares) continue;
    out.level[i] = ads33_level(*shares, kSeenShare);
    out.approval[i] = 1 + static_cast<int>(cs27_approval(*shares, kSeenShare));
    out.diverging[i] = std::any_of(shares->begin(), shares->end(), [](const ModeShare& mode) {
      return !mode.mode.oscillatory() && mode.mode.s.real() > 0.0 && mode.share >= kSeenShare;
    });
  }
  out.artifacts = count_artifacts(bare, *bare_modes, magnitude_db, truth);
  return out;
}

}  // namespace fatmc::candidates
