#include "campaigns/base/dispersion.h"

#include <cmath>

#include "campaigns/base/spec_path.h"
#include "tests/unit/campaigns_base/toml_text.h"

namespace fatmc {
namespace {

class DispersionText : public TomlTextTest {
 protected:
  std::string error_of(const std::string& text) {
    const auto dispersions = decode_dispersions(read("[[dispersion]]\n" + text));
    return dispersions ? "no error" : dispersions.error().text().substr(path_.size() + 1);
  }
  std::vector<Dispersion> decode(const std::string& text) {
    auto out = decode_dispersions(read(text));
    EXPECT_TRUE(out) << out.error().text();
    return out ? std::move(*out) : std::vector<Dispersion>{};
  }
};

const std::string kMass = "[[dispersion]]\npath = \"model.mass\"\nlaw = \"normal\"\nmean = 23.0\nsd = 0.5\n";
const std::string kSpeed = "[[dispersion]]\npath = \"model.speed\"\nlaw = \"uniform\"\nlow = 20\nhigh = 28\n";

TEST_F(DispersionText, ADrawDependsOnTheTrialAndTheNameAlone) {
  const TrialSeed trial{1, 2, 3, 4};
  const auto one = decode(kMass);
  const auto two = decode(kSpeed + kMass);
  EXPECT_EQ(one.at(0).draw(trial), two.at(1).draw(trial));
  TrialSeed other = trial;
  other.repetition = 5;
  EXPECT_NE(one.at(0).draw(trial), one.at(0).draw(other));
}

TEST_F(DispersionText, TheMiddleOfEveryLawIsInsideIt) {
  const auto all = decode(kMass + kSpeed +
                          "[[dispersion]]\npath = \"t\"\nlaw = \"truncated_normal\"\nmean = 0.0\nsd = "
                          "1.0\nlow = 0.5\nhigh = 2.0\n"
                          "[[dispersion]]\npath = \"l\"\nlaw = \"log_normal\"\nmedian = 3.0\nlog_sd = 0.1\n"
                          "[[dispersion]]\npaths = [\"a.x\", \"a.y\"]\nlaw = \"multivariate_normal\"\nmean = "
                          "[1.0, 2.0]\nsd = [0.1, 0.2]\n"
                          "correlation = [[1.0, 0.5], [0.5, 1.0]]\n");
  ASSERT_EQ(all.size(), 5U);
  EXPECT_EQ(all[0].typical(), std::vector{23.0});
  EXPECT_EQ(all[1].typical(), std::vector{24.0});
  EXPECT_EQ(all[2].typical(), std::vector{0.5});
  EXPECT_EQ(all[3].typical(), std::vector{3.0});
  EXPECT_EQ(all[4].typical(), (std::vector{1.0, 2.0}));
  EXPECT_EQ(all[4].names, (std::vector<std::string>{"x", "y"}));
}

TEST_F(DispersionText, SetAddAndScalePutTheirValueInPlace) {
  for (const auto& [apply, expected] :
       {std::pair("set", 2.0), std::pair("add", 12.0), std::pair("scale", 20.0)}) {
    const auto one = decode(
        std::string("[[dispersion]]\npath = \"a.x\"\nlaw = \"normal\"\nmean = 1.0\nsd = 1.0\napply = \"") +
        apply + "\"\n");
    Tree tree{Tree::Table{}, "t", 1};
    ASSERT_TRUE(set_at(tree, "a.x", Tree{std::int64_t{10}, "t", 1}));
    ASSERT_TRUE(apply_draw(one.at(0), {2.0}, tree));
    EXPECT_EQ(real_value(*find_at(tree, "a.x")), expected) << apply;
  }
}

TEST_F(DispersionText, ErrorsNameLineKeyAndRemedy) {
  EXPECT_EQ(error_of("path = \"a\"\nlaw = \"gauss\"\n"),
            "3: dispersion.law: \"gauss\" is not known, write one of: uniform, normal, truncated_normal, "
            "log_normal, "
            "multivariate_normal");
  EXPECT_EQ(error_of("path = \"a\"\nlaw = \"uniform\"\nlow = 2\nhigh = 1\n"),
            "5: dispersion.high: is not above low, write a larger value");
  EXPECT_EQ(error_of("path = \"a\"\nlaw = \"normal\"\nmean = 2\nsd = -1\n"),
            "5: dispersion.sd: -1 is out of range, write a value of at least 0");
  EXPECT_EQ(error_of("path = \"cell.name\"\nlaw = \"normal\"\nmean = 2\nsd = 1\n"),
            "2: dispersion.path: \"cell.name\" is no parameter of a trial");
  EXPECT_EQ(error_of("path = \"a\"\nlaw = \"truncated_normal\"\nmean = 0\nsd = 1\nlow = 40\nhigh = 41\n"),
            "6: dispersion.low: and high hold next to nothing of the normal law, write a wider interval");
  EXPECT_EQ(error_of("paths = [\"a\", \"b\"]\nlaw = \"multivariate_normal\"\nmean = [0, 0]\nsd = [1, 1]\n"
                     "correlation = [[1.0, 0.5], [0.4, 1.0]]\n"),
            "6: dispersion.correlation: is no correlation matrix, write a symmetric positive semidefinite "
            "one with ones "
            "on its diagonal");
  EXPECT_EQ(
      error_of("path = \"a\"\nlaw = \"normal\"\nmean = 0\nsd = 1\n[[dispersion]]\npath = \"b.a\"\nlaw = "
               "\"normal\"\nmean = 0\nsd = 1\n"),
      "7: dispersion.name: \"a\" is dispersed twice, write another");
  EXPECT_EQ(error_of("path = \"a\"\nlaw = \"normal\"\nmean = 0\nsd = 1\nlow = 3\n").substr(0, 42),
            "6: dispersion.low: is not a known key, the");
}

TEST_F(DispersionText, ScalingWhatIsNoNumberIsAnErrorAtTheDispersion) {
  const auto one =
      decode("[[dispersion]]\npath = \"a.x\"\nlaw = \"normal\"\nmean = 1.0\nsd = 1.0\napply = \"scale\"\n");
  Tree tree{Tree::Table{}, "t", 1};
  const Status status = apply_draw(one.at(0), {2.0}, tree);
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().line, 2);
  EXPECT_EQ(status.error().message, "\"a.x\" holds no number to scale, write apply = \"set\"");
}

}  // namespace
}  // namespace fatmc
