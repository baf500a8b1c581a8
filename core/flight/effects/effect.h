// Physical effects that a model of the aircraft may lack, as a library: what each is, its parameters, and the
// flight in which it acts.
//
//   const Result<Effect> delay = parse_effect("transport_delay:delay_s=0.03");
//   const Result<ModifiedFlight> modified = apply(aircraft, setup, {{*delay}});
//   const Result<Flight> flight = Flight::prepare(modified->aircraft, modified->setup);
//
// **Which trim.** An aircraft with an effect that moves its equilibrium (heavier, centre of gravity
// elsewhere) is flown in its own level flight at the model's speed: whoever recorded the flight had trimmed
// it before. Commands are counted from the trim of the unmodified model, since that is what its user knows.
// The record's input is therefore u = K (r - y) + u0 with the constant
//   u0 = (trim deflection of the model - trim deflection of the modified aircraft) / full command,
// so that a heavier aircraft shows in the mean of the elevator command and in the mean pitch attitude.
//
// **Changes in flight.** An effect with an onset is absent before, and its parameters move from their nominal
// values to the given ones over `duration_s` (in 100 equal steps; logarithmic parameters geometrically). The
// trim settings stay those from before: nobody has trimmed the change away.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/flight/flight.h"

namespace fatmc {

/// What a value may be and when it is moderate.
struct EffectParameter {
  std::string_view name;  ///< with its unit as suffix: "delay_s"; "factor" has none
  std::string_view unit;  ///< "s", "rad/s", ... or "1"
  std::string_view meaning;
  double nominal = 0.0;          ///< of a strength: no effect; of a shape: the value when none is given
  double low = 0.0, high = 0.0;  ///< admissible, both included
  /// A moderate effect lies between these; of a shape: where it is drawn.
  double moderate_low = 0.0, moderate_high = 0.0;
  /// The other side of nominal: none, 2 nominal - value, or nominal^2 / value.
  enum class Mirror { none, difference, ratio };
  Mirror mirror = Mirror::none;
  /// A strength at its nominal value switches the whole effect off; shapes (the frequency of a mode) do not.
  bool strength = true;
  bool logarithmic = false;  ///< its natural scale: factors, limits, frequencies

  /// From moderate_low (place 0) to moderate_high (place 1) on the natural scale; then mirrored.
  [[nodiscard]] double moderate(double place, bool mirrored) const;
  /// `share` of the way from nominal to `value` on the natural scale; a shape keeps its value.
  [[nodiscard]] double toward(double value, double share) const;
};

/// A choice that selects which axis, surface, ... the effect acts on.
struct EffectChoice {
  std::string_view name;
  std::vector<std::string_view> values;
};

struct EffectKind;

/// The choices and values that an effect is written with.
class EffectArguments {
 public:
  EffectArguments(const EffectKind& kind, const std::vector<std::pair<std::string, std::string>>& choices,
                  std::span<const double> values)
      : kind_(kind), choices_(choices), values_(values) {}
  [[nodiscard]] const EffectKind& kind() const { return kind_; }
  [[nodiscard]] double operator[](std::string_view parameter) const;
  [[nodiscard]] std::string_view choice(std::string_view name) const;
  /// 0, 1, 2 of the choice "axis": roll, pitch, yaw.
  [[nodiscard]] std::size_t axis() const;

 private:
  const EffectKind& kind_;
  const std::vector<std::pair<std::string, std::string>>& choices_;
  std::span<const double> values_;
};

struct EffectKind {
  std::string_view id;
  std::string_view title;
  std::string_view physics;  ///< a paragraph: equation, source
  std::vector<EffectChoice> choices{};
  std::vector<EffectParameter> parameters{};  ///< the strength first
  bool changes_in_flight = true;              ///< whether it may have an onset
  /// Whether the linearised airframe (`fatmc linearize`, G0) shows it; what lies in the signal path, or has
  /// states of its own, or vanishes for small motions, does not.
  bool in_linear_airframe = false;
  bool once = false;  ///< a second one of the same name would replace the first; others multiply or add
  /// Writes the effect into aircraft and setup. `reference` is the trim of the model without effects.
  void (*write)(const EffectArguments& with, const Trim& reference, Aircraft& aircraft, FlightSetup& setup);

  [[nodiscard]] const EffectParameter* parameter(std::string_view name) const;
};

/// All effects, in the order of docs/effects.md.
const std::vector<EffectKind>& effect_library();
/// The kind of that id, or null.
const EffectKind* find_effect(std::string_view id);

/// When an effect begins; it is complete `duration_s` later.
struct Onset {
  double start_s = 0.0;
  double duration_s = 0.0;
  bool operator==(const Onset&) const = default;
};

struct Effect {
  std::string id;
  std::vector<std::pair<std::string, std::string>> choices{};  ///< in the order of the kind
  std::vector<double> values{};                                ///< one a parameter, in the order of the kind
  std::optional<Onset> onset{};                                ///< none: from the start of the flight

  [[nodiscard]] const EffectKind& kind() const;  ///< the id must be known
  [[nodiscard]] double value(std::string_view parameter) const;
  [[nodiscard]] bool nominal() const;  ///< every strength is at its nominal value
  /// "id:axis=pitch,factor=0.8"; reads back to an equal effect.
  [[nodiscard]] std::string text() const;
  /// "id:axis=pitch" without values: what names an effect that has choices.
  [[nodiscard]] std::string name() const;
  bool operator==(const Effect&) const = default;
};

/// An effect of that kind with the named choices and all parameters at their nominal values.
Result<Effect> nominal_effect(std::string_view id,
                              const std::vector<std::pair<std::string, std::string>>& choices);

/// Reads "id", "id:name=value,...". Every choice and at least one strength must be given, shapes may be left
/// out; `onset_s` and `duration_s` are accepted wherever the kind may change in flight. The error is one line
/// that names what is admissible.
Result<Effect> parse_effect(std::string_view text);

/// The same from names and texts of values, as a model file gives them ([[effect]]).
Result<Effect> effect_from(std::string_view id,
                           const std::vector<std::pair<std::string, std::string>>& names_and_values);

/// What parse_effect checks, for an effect made by hand: known id, choices, ranges, onset.
Status check(const Effect& effect);

/// Every combination of choices of every kind, at nominal values: the candidates of a search.
std::vector<Effect> effect_variants();

/// What Flight::prepare takes.
struct ModifiedFlight {
  Aircraft aircraft;
  FlightSetup setup;
};

/// Aircraft and setup with the effects, one after another in the order given (a file: as written), which matters where one takes
/// what those before have left: quadratic_damping and cubic_moment the derivative, gyro_misalignment scale and turn (docs/effects.md).
/// Effects at nominal values leave both equal to what was given. Fails on an invalid effect or where the aircraft, with or
/// without the effects, has no level flight.
Result<ModifiedFlight> apply(const Aircraft& aircraft, const FlightSetup& setup,
                             std::span<const Effect> effects);

}  // namespace fatmc
