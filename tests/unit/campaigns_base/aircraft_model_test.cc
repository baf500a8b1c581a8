#include "campaigns/base/aircraft_model.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <sstream>

#include "campaigns/base/effect_tables.h"
#include "coordinator/input/toml_file.h"

namespace fatmc {
namespace {

class ModelFile : public testing::Test {
 protected:
  const std::string path_ = testing::TempDir() + "aircraft_model_test_" +
                            testing::UnitTest::GetInstance()->current_test_info()->name() + ".toml";
  void TearDown() override { std::remove(path_.c_str()); }

  /// fat.toml with the first line that starts with `line` replaced; the error's text.
  std::string error_with(const std::string& line, const std::string& replacement) {
    std::ifstream in("campaigns/models/fat.toml");
    std::ofstream out(path_);
    bool done = false;
    for (std::string text; std::getline(in, text);) {
      const bool here = !done && text.rfind(line, 0) == 0;
      done = done || here;
      out << (here ? replacement : text) << "\n";
    }
    out.close();
    EXPECT_TRUE(done);
    const Result<Tree> tree = read_toml(path_);
    if (!tree) return tree.error().text();
    const Result<AircraftModel> model = decode_aircraft_model(*tree);
    return model ? "" : model.error().text();
  }
};

TEST_F(ModelFile, EffectTablesPatchTheFlightAndLeaveTheParentAsItIs) {
  const AircraftModel parent = *decode_aircraft_model(*read_toml("campaigns/models/fat.toml"));
  const std::vector<Effect> wanted = {*parse_effect("control_effectiveness:axis=pitch,factor=0.8"),
                                      *parse_effect("transport_delay:delay_s=0.03,onset_s=100")};
  {
    std::ifstream in("campaigns/models/fat.toml");
    std::ofstream out(path_);
    out << in.rdbuf();
    for (const Effect& effect : wanted) out << "\n" << effect_toml(effect);
  }
  const Result<AircraftModel> patched = decode_aircraft_model(*read_toml(path_));
  ASSERT_TRUE(patched) << patched.error().text();
  EXPECT_TRUE(patched->effects == wanted);
  EXPECT_TRUE(patched->aircraft == parent.aircraft);
  const Result<ModifiedFlight> modified = modified_flight(*patched, FlightSetup{});
  ASSERT_TRUE(modified) << modified.error().text();
  EXPECT_EQ(modified->aircraft.pitch.eta, 0.8 * parent.aircraft.pitch.eta);
  EXPECT_EQ(modified->setup.path.command_delay_s, 0.0);
  ASSERT_EQ(modified->setup.stages.size(), 1u);
  EXPECT_EQ(modified->setup.stages[0].path.command_delay_s, 0.03);
  const Result<ModifiedFlight> plain = modified_flight(parent, FlightSetup{});
  ASSERT_TRUE(plain);
  EXPECT_TRUE(plain->aircraft == parent.aircraft);
  EXPECT_TRUE(plain->setup == FlightSetup{});
}

TEST_F(ModelFile, AWrongEffectIsSaidWithFileLineAndWhatIsAdmissible) {
  const std::string file = path_;
  const auto message = [&](const std::string& table) {
    return error_with("kind = ", "kind = \"aircraft\"\n# a comment\n") + error_with("bits = 13", "bits = 13\n" + table);
  };
  const std::string range = message("[[effect]]\nid = \"transport_delay\"\ndelay_s = 9.0");
  EXPECT_NE(range.find(file + ":"), std::string::npos) << range;
  EXPECT_NE(range.find("0 to 2"), std::string::npos) << range;
  EXPECT_NE(message("[[effect]]\naxis = \"roll\"").find("effect.id"), std::string::npos);
  EXPECT_NE(message("[[effect]]\nid = \"telepathy\"").find("transport_delay"), std::string::npos);
}

TEST_F(ModelFile, TheFatDecodesWithTwoGradesOfGyros) {
  const Result<AircraftModel> model = decode_aircraft_model(*read_toml("campaigns/models/fat.toml"));
  ASSERT_TRUE(model);
  EXPECT_EQ(model->aircraft.mass_kg, 23.0);
  EXPECT_NE(model->imu("tactical"), nullptr);
  EXPECT_NE(model->imu("industrial"), nullptr);
  EXPECT_EQ(model->imu("strategic"), nullptr);
  EXPECT_NEAR(model->imu("tactical")->bias_rad_s[0], 6.0 * kPi / 180.0 / 3600.0, 1e-18);
}

TEST_F(ModelFile, AWrongKeyIsReportedWithLineAndKnownKeys) {
  const std::string error = error_with("mass_kg", "mess_kg = 23.0");
  EXPECT_NE(error.find("mass.mass_kg: is missing"), std::string::npos) << error;
  const std::string extra = error_with("mass_kg", "mass_kg = 23.0\ncolour = 1");
  EXPECT_NE(extra.find("mass.colour: is not a known key"), std::string::npos) << extra;
  EXPECT_NE(extra.find(path_ + ":"), std::string::npos) << extra;
}

TEST_F(ModelFile, AValueOutOfRangeIsReportedWithItsLine) {
  const std::string error = error_with("span_m", "span_m = -5.0");
  EXPECT_NE(error.find("geometry.span_m: -5 is out of range"), std::string::npos) << error;
}

TEST_F(ModelFile, AWrongTypeInAGradeIsReported) {
  const std::string error = error_with("bias_deg_h", "bias_deg_h = [6.0, 6.0]");
  EXPECT_NE(error.find("imu.tactical.bias_deg_h: has 2 numbers, write 3"), std::string::npos) << error;
}

TEST_F(ModelFile, AnInertiaThatNoBodyHasIsRefused) {
  const std::string error = error_with("izz_kg_m2", "izz_kg_m2 = 40.0");
  EXPECT_NE(error.find("mass.izz_kg_m2: one moment of inertia"), std::string::npos) << error;
}

TEST_F(ModelFile, AnotherKindIsRefused) {
  const std::string error = error_with("kind", "kind = \"balloon\"");
  EXPECT_NE(error.find("kind: \"balloon\" is not known, write one of: aircraft"), std::string::npos) << error;
}

}  // namespace
}  // namespace fatmc
