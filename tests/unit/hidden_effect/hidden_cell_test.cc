#include "campaigns/hidden_effect/hidden_cell.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "campaigns/base/prepared_trials.h"
#include "coordinator/input/toml_file.h"

namespace fatmc::hidden_effect {
namespace {

using testing::HasSubstr;

/// The spec of the study with other cells.
Result<HiddenCell> decoded(const std::string& cell, const std::string& search = "") {
  const std::string path =
      (std::filesystem::temp_directory_path() / ("hidden_cell_test_" + std::to_string(getpid()) + ".toml"));
  const std::string root = std::filesystem::current_path().string() + "/campaigns/";
  std::ofstream(path) << "model = \"" + root + "models/fat.toml\"\nexperiment = \"" + root +
                             "experiments/chapter5.toml\"\n[campaign]\nstudy = \"hidden_effect\"\nname = "
                             "\"test\"\nseed = 1\n" +
                             search + "\n[[cell]]\nname = \"one\"\nrepetitions = 1\n" + cell;
  const auto tree = read_toml_resolved(path);
  std::filesystem::remove(path);
  if (!tree) return fail(tree.error());
  const auto spec = decode_campaign(*tree);
  if (!spec) return fail(spec.error());
  const auto own = spec_of_cell(*spec, 0);
  if (!own) return fail(own.error());
  return decode_hidden_cell(*own, 0);
}

TEST(HiddenCell, ReadsWhatACellHidesAndWhatIsExpectedOfTheSearch) {
  const auto cell = decoded(
      "tier = \"guard\"\nhidden = [\"mass\"]\nlevels = [1.0, 0.4]\nnominal_error = [0.03, 0.05]\nuncertain = "
      "[\"cl_p\"]\n",
      "[search]\nclasses = [[\"cn_r\", \"cy_beta\"], [\"loop_gain:axis=roll\", "
      "\"control_effectiveness\"]]\n");
  ASSERT_TRUE(cell) << cell.error().text();
  EXPECT_EQ(cell->tier.role, Role::guard);
  EXPECT_EQ(cell->tier.levels, (std::vector<double>{1.0, 0.4}));
  EXPECT_EQ(cell->tier.draw.nominal_error, (std::array<double, 2>{0.03, 0.05}));
  EXPECT_EQ(cell->classes.size(), 2u);
}

TEST(HiddenCell, AnotherAircraftOrExperimentIsAnotherSearchAndWhatIsHiddenIsNot) {
  const auto plain = decoded("hidden = [\"mass\"]\n"),
             other = decoded("hidden = [\"inertia\"]\nsize = 0.25\n");
  const auto louder = decoded("hidden = [\"mass\"]\namplitude_rad_s = [0.1, 0.1, 0.1]\n");
  const auto aerosonde =
      decoded("hidden = [\"mass\"]\nset.model = \"" + std::filesystem::current_path().string() +
              "/campaigns/models/aerosonde.toml\"\n");
  ASSERT_TRUE(plain && other && louder);
  ASSERT_TRUE(aerosonde) << aerosonde.error().text();
  EXPECT_EQ(plain->search_key, other->search_key);
  EXPECT_NE(plain->search_key, louder->search_key);
  EXPECT_NE(plain->search_key, aerosonde->search_key);
  EXPECT_EQ(aerosonde->flown.model.aircraft.name, "Aerosonde");
  EXPECT_EQ(aerosonde->flown.model.aircraft.mass_kg, 11.0);
}

TEST(HiddenCell, RefusesInOneLineWhatCannotBe) {
  const auto message = [](const std::string& cell, const std::string& search = "") {
    const auto wrong = decoded(cell, search);
    return wrong ? std::string("no error") : wrong.error().text();
  };
  EXPECT_THAT(message("hidden = [\"gremlins\"]\n"), HasSubstr("\"gremlins\" is no effect"));
  EXPECT_THAT(message("hidden = []\n"), HasSubstr("hidden: is empty"));
  EXPECT_THAT(message("tier = \"two\"\nhidden = [\"mass\"]\n"), HasSubstr("write hide = 2"));
  EXPECT_THAT(message("tier = \"easy\"\nhidden = [\"mass\"]\n"), HasSubstr("tier"));
  EXPECT_THAT(message("hidden = [\"mass\"]\nnominal_error = [0.05, 0.03]\n"),
              HasSubstr("smaller error first"));
  EXPECT_THAT(message("hidden = [\"mass\"]\nlevels = []\n"), HasSubstr("levels"));
  EXPECT_THAT(message("hidden = [\"mass\"]\n", "[search]\nclasses = [[\"cn_r\"]]\n"),
              HasSubstr("two names and more"));
  EXPECT_THAT(message("hidden = [\"mass\"]\n", "[search]\nclasses = [[\"cn_r\", \"gremlins\"]]\n"),
              HasSubstr("classes"));
}

}  // namespace
}  // namespace fatmc::hidden_effect
