#include "campaigns/hidden_effect/limit_size.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/flight/effects/effect_limit.h"

namespace fatmc::hidden_effect {
namespace {

/// Rates without gusts and sensor errors; none where the flight ends early.
std::optional<Eigen::MatrixX3d> quiet_rates(const Aircraft& aircraft, FlightSetup setup,
                                            const std::vector<Effect>& effects,
                                            const Eigen::Ref<const Eigen::MatrixX3d>& reference) {
  setup.turbulence_m_s = 0.0;
  setup.imu = Imu{};
  const auto modified = apply(aircraft, setup, effects);
  if (!modified) return std::nullopt;
  const auto flight = Flight::prepare(modified->aircraft, modified->setup);
  if (!flight) return std::nullopt;
  FlightRecord flown;
  flight->fly(reference, {}, flown);
  if (flown.ending != Ending::completed) return std::nullopt;
  return std::move(flown.output);
}

}  // namespace

Effect share_of_limit(const Effect& effect, double share, const Aircraft& aircraft, const FlightSetup& setup,
                      const Eigen::Ref<const Eigen::MatrixX3d>& reference) {
  const EffectParameter& parameter = effect.kind().parameters.front();
  if (!is_limit(parameter) || share == 1.0 || !(share > 0.0)) return effect;
  const auto plain = quiet_rates(aircraft, setup, {}, reference);
  if (!plain) return effect;
  const auto change = [&](double limit) -> std::optional<double> {
    Effect with = effect;
    with.values.front() = limit;
    const auto rates = quiet_rates(aircraft, setup, {with}, reference);
    if (!rates) return std::nullopt;
    return (*rates - *plain).norm();
  };
  const std::optional<double> whole = change(effect.values.front());
  if (!whole || !(*whole > 0.0)) return effect;
  // The change falls as the limit rises: bracket by steps of a fifth, then halve in the logarithm.
  const double step = share < 1.0 ? 1.2 : 1.0 / 1.2;
  double near = effect.values.front(), far = near;
  int flights = 0;
  const auto beyond = [&](double change_there) {
    return share < 1.0 ? change_there <= share * *whole : change_there >= share * *whole;
  };
  for (bool found = false; !found; ++flights) {
    if (flights == LimitSearch::kMostFlights) return effect;
    near = far;
    far = std::clamp(far * step, parameter.low, parameter.high);
    const std::optional<double> there = change(far);
    if (!there || far == near) return effect;
    found = beyond(*there);
  }
  double middle = far;
  for (; flights < LimitSearch::kMostFlights; ++flights) {
    middle = std::sqrt(near * far);
    const std::optional<double> there = change(middle);
    if (!there) return effect;
    if (std::abs(*there / (share * *whole) - 1.0) < LimitSearch::kTolerance) break;
    (beyond(*there) ? far : near) = middle;
  }
  Effect out = effect;
  out.values.front() = middle;
  return out;
}

}  // namespace fatmc::hidden_effect
