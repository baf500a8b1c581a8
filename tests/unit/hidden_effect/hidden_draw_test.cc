#include "campaigns/hidden_effect/hidden_draw.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>

namespace fatmc::hidden_effect {
namespace {

RandomStream stream(std::uint64_t repetition) {
  return {{1, name_hash("draw test"), 0, repetition}, "hidden"};
}

/// Files of the project that a file includes, directly or through others.
void collect(const std::string& path, std::set<std::string>& seen) {
  if (!std::filesystem::exists(path) || !seen.insert(path).second) return;
  std::ifstream in(path);
  const std::regex include("^\\s*#include \"([^\"]+)\"");
  for (std::string line; std::getline(in, line);) {
    std::smatch match;
    if (std::regex_search(line, match, include)) collect(match[1], seen);
  }
}

TEST(HiddenDraw, IncludesNothingOfTheSearchNotEvenThroughOthers) {
  std::set<std::string> seen;
  for (const char* file : {"hidden_draw.cc", "hidden_draw.h", "limit_size.cc", "limit_size.h"})
    collect("campaigns/hidden_effect/" + std::string(file), seen);
  EXPECT_TRUE(seen.contains("core/flight/effects/effect.h")) << "the walk follows includes";
  EXPECT_GT(seen.size(), 10u);
  for (const std::string& file : seen) EXPECT_EQ(file.find("core/discrepancy"), std::string::npos) << file;
}

TEST(HiddenDraw, IsAPureFunctionOfTheStream) {
  const Tier tier{2, 1.0, {"mass", "inertia", "gyro_scale"}, {0.03, 0.05}, {"cl_p", "cn_r"}, 0.2};
  RandomStream a = stream(5), b = stream(5), c = stream(6);
  const Drawn first = draw(tier, a), again = draw(tier, b), other = draw(tier, c);
  EXPECT_EQ(first.effects, again.effects);
  EXPECT_EQ(first.errors, again.errors);
  EXPECT_NE(first.errors, other.errors);
  EXPECT_EQ(first.errors.size(), 3u);
}

TEST(HiddenDraw, DrawsAdmissibleEffectsOfDifferentKindsAndEveryVariant) {
  const Tier tier{2, 1.0, {"mass", "inertia", "gyro_scale:axis=pitch"}, {}, {}, 0.0};
  std::set<std::string> names;
  for (std::uint64_t n = 0; n < 200; ++n) {
    RandomStream random = stream(n);
    const Drawn drawn = draw(tier, random);
    ASSERT_EQ(drawn.effects.size(), 2u);
    EXPECT_NE(drawn.effects[0].id, drawn.effects[1].id);
    for (const Effect& e : drawn.effects) {
      EXPECT_TRUE(check(e)) << e.text();
      EXPECT_FALSE(e.nominal());
      names.insert(e.name());
    }
  }
  EXPECT_EQ(names.size(), 5u);
}

TEST(HiddenDraw, NominalErrorsLieBetweenTheirBoundsOnEitherSide) {
  const Tier tier{0, 1.0, {}, {0.03, 0.05}, {"cl_p"}, 0.0};
  int above = 0;
  for (std::uint64_t n = 0; n < 100; ++n) {
    RandomStream random = stream(n);
    const double factor = draw(tier, random).errors.front().values.front();
    EXPECT_GE(std::abs(factor - 1.0), 0.03);
    EXPECT_LE(std::abs(factor - 1.0), 0.05);
    above += factor > 1.0 ? 1 : 0;
  }
  // 100 even draws: 50 +- 5.
  EXPECT_GT(above, 30);
  EXPECT_LT(above, 70);
}

TEST(HiddenDraw, AQuarterOfASizeIsAQuarterOfTheWayFromNominal) {
  RandomStream a = stream(1), b = stream(1);
  const Effect whole = draw({1, 1.0, {"gyro_scale:axis=roll"}, {}, {}, 0.0}, a).effects.front();
  const Effect quarter = draw({1, 0.25, {"gyro_scale:axis=roll"}, {}, {}, 0.0}, b).effects.front();
  EXPECT_NEAR(quarter.values[0], 0.25 * whole.values[0], 1e-15);
}

}  // namespace
}  // namespace fatmc::hidden_effect
