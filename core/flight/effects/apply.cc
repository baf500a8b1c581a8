#include <algorithm>
#include <cmath>

#include "core/base/text.h"
#include "core/flight/effects/effect.h"

namespace fatmc {
namespace {

constexpr int kDriftSteps = 100;

/// How much of an effect is there at a time.
double share_at(const Effect& effect, double time_s) {
  if (!effect.onset) return 1.0;
  const auto& [start, duration] = *effect.onset;
  if (time_s < start - 1e-9) return 0.0;
  if (duration <= 0.0) return 1.0;
  // The step that begins at this time is flown with its middle.
  const double step = std::floor((time_s - start) / duration * kDriftSteps + 1e-6);
  return step < kDriftSteps ? (step + 0.5) / kDriftSteps : 1.0;
}

ModifiedFlight written(const Aircraft& aircraft, const FlightSetup& setup, const Trim& reference,
                       std::span<const Effect> effects, double time_s) {
  ModifiedFlight out{aircraft, setup};
  for (const Effect& effect : effects) {
    const double share = share_at(effect, time_s);
    if (share == 0.0) continue;
    const EffectKind& kind = effect.kind();
    std::vector<double> values = effect.values;
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = kind.parameters[i].toward(values[i], share);
    kind.write(EffectArguments(kind, effect.choices, values), reference, out.aircraft, out.setup);
  }
  return out;
}

std::vector<double> change_times(std::span<const Effect> effects) {
  std::vector<double> times;
  for (const Effect& effect : effects) {
    if (!effect.onset) continue;
    const auto& [start, duration] = *effect.onset;
    const int steps = duration > 0.0 ? kDriftSteps : 0;
    for (int i = 0; i <= steps; ++i) times.push_back(start + duration * i / kDriftSteps);
  }
  std::sort(times.begin(), times.end());
  times.erase(std::unique(times.begin(), times.end()), times.end());
  return times;
}

Result<Trim> level(const Aircraft& aircraft, std::string_view whose) {
  Trim trim = trim_level(aircraft);
  if (trim.usable()) return trim;
  return fail(Error{"", 0, "effect",
                    "no level flight " + std::string(whose) + " at " + shortest(aircraft.speed_m_s) +
                        " m/s, write a smaller effect"});
}

Status check_all(std::span<const Effect> effects) {
  std::vector<std::string> seen;
  for (const Effect& effect : effects) {
    if (Status status = check(effect); !status) return status;
    if (!effect.kind().once) continue;
    if (std::find(seen.begin(), seen.end(), effect.name()) != seen.end()) {
      return fail(
          Error{"", 0, "effect", effect.name() + " is given twice; the second would replace the first"});
    }
    seen.push_back(effect.name());
  }
  return {};
}

}  // namespace

Result<ModifiedFlight> apply(const Aircraft& aircraft, const FlightSetup& setup,
                             std::span<const Effect> effects) {
  if (Status status = check_all(effects); !status) return fail(status.error());
  if (std::all_of(effects.begin(), effects.end(), [](const Effect& e) { return e.nominal(); })) {
    return ModifiedFlight{aircraft, setup};
  }
  const Result<Trim> reference = level(aircraft, "of the aircraft without effects");
  if (!reference) return fail(reference.error());
  ModifiedFlight out = written(aircraft, setup, *reference, effects, 0.0);
  if (out.aircraft != aircraft) {
    if (Status status = check(out.aircraft); !status) {
      return fail(Error{"", 0, "effect", "gives an aircraft that cannot be: " + status.error().text()});
    }
    const Result<Trim> trim = level(out.aircraft, "with the effects");
    if (!trim) return fail(trim.error());
    out.setup.path.command_offset[1] += (reference->eta_rad - trim->eta_rad) / aircraft.full_command_rad;
  }
  for (const double time_s : change_times(effects)) {
    if (time_s <= 0.0) continue;
    const ModifiedFlight then = written(aircraft, setup, *reference, effects, time_s);
    FlightStage stage{time_s, then.aircraft, then.setup.imu, then.setup.gain, then.setup.path};
    stage.path.command_offset = out.setup.path.command_offset;
    out.setup.stages.push_back(std::move(stage));
  }
  return out;
}

}  // namespace fatmc
