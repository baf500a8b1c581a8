// The library of effects as a whole: what every effect must do.
#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <sstream>

#include "core/flight/effects/effect.h"
#include "core/flight/effects/listing.h"
#include "tests/unit/flight/fat.h"

namespace fatmc {
namespace {

FlightSetup windy() {
  FlightSetup setup;
  setup.turbulence_m_s = 0.5;
  setup.imu.noise_rad_sqrt_s = 2e-5;
  setup.imu.bias_rad_s = {1e-4, 2e-4, 3e-4};
  return setup;
}

Eigen::MatrixX3d reference(Eigen::Index ticks) {
  Eigen::MatrixX3d r(ticks, 3);
  for (Eigen::Index t = 0; t < ticks; ++t) {
    const double s = 0.02 * static_cast<double>(t);
    r.row(t) << 0.4 * std::sin(3.0 * s), 0.2 * std::sin(4.0 * s), 0.2 * std::sin(5.0 * s);
  }
  return r;
}

FlightRecord flown(const ModifiedFlight& modified, Eigen::Index ticks = 250) {
  const Result<Flight> flight = Flight::prepare(modified.aircraft, modified.setup);
  EXPECT_TRUE(flight.has_value()) << flight.error().text();
  FlightRecord record;
  if (flight) flight->fly(reference(ticks), TrialSeed{1, 2, 3, 4}, record);
  return record;
}

/// All strengths at a moderate size, shapes as given.
Effect moderate(Effect effect, bool mirrored) {
  const EffectKind& kind = effect.kind();
  for (std::size_t i = 0; i < effect.values.size(); ++i) {
    if (kind.parameters[i].strength) effect.values[i] = kind.parameters[i].moderate(0.5, mirrored);
  }
  return effect;
}

TEST(EffectLibrary, HasAtLeastTwentyFourEffectsWithDistinctNames) {
  std::set<std::string_view> ids;
  for (const EffectKind& kind : effect_library()) {
    EXPECT_TRUE(ids.insert(kind.id).second) << kind.id;
    EXPECT_FALSE(kind.physics.empty()) << kind.id;
    EXPECT_TRUE(kind.parameters.at(0).strength) << kind.id;
  }
  EXPECT_GE(ids.size(), 24u);
}

TEST(EffectLibrary, NominalAndModerateValuesAreAdmissible) {
  for (const EffectKind& kind : effect_library()) {
    for (const EffectParameter& p : kind.parameters) {
      for (const double value : {p.nominal, p.moderate(0.0, false), p.moderate(1.0, false),
                                 p.moderate(0.0, true), p.moderate(1.0, true)}) {
        EXPECT_GE(value, p.low) << kind.id << " " << p.name;
        EXPECT_LE(value, p.high) << kind.id << " " << p.name;
      }
    }
  }
}

TEST(EffectLibrary, AWrittenNominalEffectLeavesAircraftAndSetupAsTheyAre) {
  const Trim trim = trim_level(fat());
  for (const Effect& effect : effect_variants()) {
    Aircraft aircraft = fat();
    FlightSetup setup = windy();
    const EffectKind& kind = effect.kind();
    kind.write(EffectArguments(kind, effect.choices, effect.values), trim, aircraft, setup);
    EXPECT_TRUE(aircraft == fat()) << effect.text();
    EXPECT_TRUE(setup == windy()) << effect.text();
  }
}

TEST(EffectLibrary, ANominalEffectFliesTheUnmodifiedFlightBitForBit) {
  const FlightRecord plain = flown({fat(), windy()});
  for (const Effect& effect : effect_variants()) {
    const Result<ModifiedFlight> modified = apply(fat(), windy(), {{effect}});
    ASSERT_TRUE(modified.has_value()) << effect.text() << ": " << modified.error().text();
    const FlightRecord record = flown(*modified);
    EXPECT_TRUE((record.output.array() == plain.output.array()).all()) << effect.text();
    EXPECT_TRUE((record.input.array() == plain.input.array()).all()) << effect.text();
    EXPECT_TRUE((record.auxiliary.array() == plain.auxiliary.array()).all()) << effect.text();
  }
}

TEST(EffectLibrary, AModerateEffectChangesTheRecordAndTheFlightEnds) {
  const FlightRecord plain = flown({fat(), windy()}, 1500);
  for (const Effect& variant : effect_variants()) {
    for (const bool mirrored : {false, true}) {
      const Effect effect = moderate(variant, mirrored);
      const Result<ModifiedFlight> modified = apply(fat(), windy(), {{effect}});
      ASSERT_TRUE(modified.has_value()) << effect.text() << ": " << modified.error().text();
      const FlightRecord record = flown(*modified, 1500);
      EXPECT_EQ(record.ending, Ending::completed) << effect.text() << " " << name(record.ending);
      EXPECT_GT((record.output - plain.output).norm() + (record.input - plain.input).norm(), 0.0)
          << effect.text();
    }
  }
}

TEST(EffectLibrary, AWeakEffectIsNearTheUnmodifiedFlight) {
  // Continuity at nominal: what a fit relies on. Limits begin to act at a finite value and are left out.
  const FlightRecord plain = flown({fat(), FlightSetup{}});
  for (const Effect& variant : effect_variants()) {
    Effect effect = moderate(variant, false);
    const EffectParameter& strength = effect.kind().parameters[0];
    if (strength.nominal > 20.0) continue;
    effect.values[0] = strength.toward(effect.values[0], 1e-6);
    const Result<ModifiedFlight> modified = apply(fat(), FlightSetup{}, {{effect}});
    ASSERT_TRUE(modified.has_value()) << effect.text();
    EXPECT_LT((flown(*modified).output - plain.output).cwiseAbs().maxCoeff(), 1e-5) << effect.text();
  }
}

TEST(EffectText, TheTableOfTheDocumentationIsThatOfTheLibrary) {
  std::ifstream in("docs/effects.md");
  std::stringstream page;
  page << in.rdbuf();
  EXPECT_NE(page.str().find(effect_table_markdown()), std::string::npos)
      << "put the output of fatmc simulate --effect table there";
}

TEST(EffectText, ReadsBackToAnEqualEffect) {
  for (const Effect& variant : effect_variants()) {
    Effect effect = moderate(variant, true);
    if (effect.kind().changes_in_flight) effect.onset = Onset{12.5, 3.25};
    const Result<Effect> read = parse_effect(effect.text());
    ASSERT_TRUE(read.has_value()) << effect.text() << ": " << read.error().text();
    EXPECT_TRUE(*read == effect) << effect.text();
  }
}

TEST(EffectText, TheContractsExamplesAreRead) {
  const Result<Effect> delay = parse_effect("transport_delay:delay_s=0.03");
  ASSERT_TRUE(delay.has_value());
  EXPECT_EQ(delay->value("delay_s"), 0.03);
  const Result<Effect> pitch = parse_effect("control_effectiveness:axis=pitch,factor=0.8");
  ASSERT_TRUE(pitch.has_value());
  EXPECT_EQ(pitch->name(), "control_effectiveness:axis=pitch");
  EXPECT_EQ(pitch->value("factor"), 0.8);
  // In any order, and shapes may be left out.
  EXPECT_EQ(parse_effect("control_effectiveness:factor=0.8,axis=pitch")->text(), pitch->text());
  EXPECT_EQ(parse_effect("flexible_mode:axis=roll,slope=0.01")->value("damping"), 0.03);
}

TEST(EffectText, WhatIsWrongIsSaidInOneLineWithWhatIsAdmissible) {
  const auto message = [](std::string_view text) {
    const Result<Effect> effect = parse_effect(text);
    EXPECT_FALSE(effect.has_value()) << text;
    const std::string out = effect ? "" : effect.error().text();
    EXPECT_EQ(out.find('\n'), std::string::npos);
    return out;
  };
  EXPECT_NE(message("delay:delay_s=1").find("transport_delay"), std::string::npos);
  EXPECT_NE(message("transport_delay").find("delay_s (0 to 2)"), std::string::npos);
  EXPECT_NE(message("transport_delay:delay_s=3").find("0 to 2"), std::string::npos);
  EXPECT_NE(message("transport_delay:delay_s=nan").find("delay_s"), std::string::npos);
  EXPECT_NE(message("transport_delay:delay_s=0.1,delay_s=0.2").find("twice"), std::string::npos);
  EXPECT_NE(message("control_effectiveness:axis=yawn,factor=1").find("roll, pitch, yaw"), std::string::npos);
  EXPECT_NE(message("control_effectiveness:factor=0.8").find("needs axis"), std::string::npos);
  EXPECT_NE(message("control_effectiveness:axis=yaw,gain=2").find("factor (0.05 to 20)"), std::string::npos);
  EXPECT_NE(message("control_effectiveness:axis=yaw").find("factor"), std::string::npos);
  EXPECT_NE(message("turbulence:factor=2,onset_s=1").find("cannot begin in flight"), std::string::npos);
  EXPECT_NE(message("cm_q:factor=2,duration_s=1").find("onset_s"), std::string::npos);
  EXPECT_NE(message("cm_q:factor").find("name=value"), std::string::npos);
}

TEST(EffectApplication, RefusesWhatCannotBeFlown) {
  EXPECT_FALSE(apply(fat(), windy(), {{*parse_effect("mass:factor=3")}}).has_value());
  const Effect mode = *parse_effect("flexible_mode:axis=roll,slope=0.01");
  EXPECT_FALSE(apply(fat(), windy(), {{mode, mode}}).has_value());
  FlightSetup linear = windy();
  linear.plant = FlightSetup::Plant::linear;
  const Result<ModifiedFlight> modified = apply(fat(), linear, {{mode}});
  ASSERT_TRUE(modified.has_value());
  EXPECT_FALSE(Flight::prepare(modified->aircraft, modified->setup).has_value());
}

}  // namespace
}  // namespace fatmc
