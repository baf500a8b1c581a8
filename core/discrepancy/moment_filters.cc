#include "core/discrepancy/moment_filters.h"

#include <Eigen/LU>
#include <algorithm>
#include <complex>
#include <memory>

#include "core/base/check.h"
#include "core/discrepancy/effect_size.h"
#include "core/discrepancy/model_simulator.h"
#include "core/signal/dft.h"

namespace fatmc {
namespace {

using Spectrum = Eigen::MatrixX3cd;

constexpr double kSingular = 1e-9;  // of the noise's mean power: a rate without noise keeps an inverse
constexpr double kNothing = 1e-6;   // of a deviation: less than that shows nowhere

/// Bins 0 ... last of p, q, r, the straight line from first to last sample taken off as in record_features.cc.
Spectrum spectrum(const LoopRecord& record, const RealDft& dft, int last) {
  std::vector<std::complex<double>> bins(static_cast<std::size_t>(last + 1));
  std::vector<double> samples;
  Spectrum out(last + 1, 3);
  for (Eigen::Index c = 0; c < 3; ++c) {
    level_ends({record.output.col(c).data(), static_cast<std::size_t>(record.output.rows())}, samples);
    dft.transform(samples, bins);
    for (int k = 0; k <= last; ++k) out(k, c) = bins[static_cast<std::size_t>(k)];
  }
  return out;
}

/// S(k)^-1 at the wanted bins, from bins that are no harmonics.
std::vector<Eigen::Matrix3cd> inverse_noise(const std::vector<Spectrum>& flights, int periods,
                                            const std::vector<int>& wanted) {
  const auto count = static_cast<int>(flights.front().rows());
  std::vector<Eigen::Matrix3cd> power(static_cast<std::size_t>(count), Eigen::Matrix3cd::Zero());
  for (const Spectrum& y : flights) {
    for (int k = 1; k < count; ++k) {
      if (k % periods != 0) power[static_cast<std::size_t>(k)] += y.row(k).transpose() * y.row(k).conjugate();
    }
  }
  std::vector<Eigen::Matrix3cd> out;
  for (const int k : wanted) {
    Eigen::Matrix3cd sum = Eigen::Matrix3cd::Zero();
    int bins = 0;
    const int width = std::clamp(k / 4, MomentFilters::kLeastWidth, MomentFilters::kMostWidth);
    const int last = std::min(count - 1, k + width);
    for (int m = std::max(1, k - width); m <= last; ++m) {
      if (m % periods == 0) continue;
      sum += power[static_cast<std::size_t>(m)];
      ++bins;
    }
    sum /= static_cast<double>(bins) * static_cast<double>(flights.size());
    sum.diagonal().array() += kSingular * sum.trace().real() / 3.0 + 1e-300;
    out.emplace_back(sum.inverse());
  }
  return out;
}

/// Harmonics of the period that are not excited.
std::vector<int> quiet_harmonics(const PeriodicExperiment& experiment) {
  const int half = (experiment.period_samples - 1) / 2;
  const int most = std::min(half, static_cast<int>(MomentFilters::kBandFactor * experiment.lines.back()));
  std::vector<int> out;
  for (int k = 1; k <= most; ++k) {
    if (!std::binary_search(experiment.lines.begin(), experiment.lines.end(), k))
      out.push_back(k * experiment.periods);
  }
  return out;
}

/// The model in calm air with exact gyros.
ModelSimulator quiet(const ModelSimulator& model) {
  FlightSetup setup = model.setup();
  setup.turbulence_m_s = 0.0;
  setup.imu = {};
  return {model.aircraft(), setup, model.own_effects(), model.reference(), model.extractor()};
}

MomentFilters make_filters(const ModelSimulator& model) {
  MomentFilters out;
  const PeriodicExperiment& experiment = model.extractor().layout().experiment;
  const RealDft dft(experiment.period_samples * experiment.periods);
  const int last = std::min(dft.size() / 2, static_cast<int>(MomentFilters::kBandFactor *
                                                             experiment.lines.back() * experiment.periods) +
                                                MomentFilters::kMostWidth);
  const std::vector<int> bins = quiet_harmonics(experiment);
  std::vector<Spectrum> flights;
  for (int n = 0; n < MomentFilters::kNoiseFlights; ++n) {
    if (const auto record = model.record({}, n)) flights.push_back(spectrum(*record, dft, last));
  }
  const ModelSimulator calm = quiet(model);
  const auto plain = calm.record({}, 0);
  if (flights.empty() || !plain || bins.empty()) return out;
  const std::vector<Eigen::Matrix3cd> inverse = inverse_noise(flights, experiment.periods, bins);
  const Spectrum base = spectrum(*plain, dft, last);
  for (const Effect& moment : higher_moments()) {
    const auto record = calm.record({&moment, 1}, 0);
    if (!record) continue;
    const Spectrum difference = spectrum(*record, dft, last) - base;
    Spectrum weight(static_cast<Eigen::Index>(bins.size()), 3);
    double energy = 0.0;
    for (std::size_t i = 0; i < bins.size(); ++i) {
      const Eigen::Vector3cd d = difference.row(bins[i]).transpose(), w = inverse[i] * d;
      weight.row(static_cast<Eigen::Index>(i)) = w.transpose();
      energy += 2.0 * d.dot(w).real();
    }
    if (!(energy > kNothing * kNothing)) continue;
    out.moments.push_back(moment);
    out.weights.emplace_back(2.0 / std::sqrt(energy) * weight);
  }
  if (!out.moments.empty()) out.bins = bins;
  return out;
}

std::vector<Effect> make_moments() {
  std::vector<Effect> out;
  for (Effect effect : effect_variants()) {
    if (effect.id != "quadratic_damping" && effect.id != "cubic_moment") continue;
    const EffectParameter& ratio = effect.kind().parameters.front();
    effect.values.front() = ratio.moderate(place_of_least(ratio), false);
    out.push_back(std::move(effect));
  }
  return out;
}

}  // namespace

const std::vector<Effect>& higher_moments() {
  static const std::vector<Effect> all = make_moments();
  return all;
}

ModelSimulator with_moment_filters(const ModelSimulator& plain) {
  return {plain.aircraft(), plain.setup(), plain.own_effects(), plain.reference(),
          plain.extractor().with(std::make_shared<const MomentFilters>(make_filters(plain)))};
}

}  // namespace fatmc
