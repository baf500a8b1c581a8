#include "campaigns/hidden_effect/limit_size.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/signal/multisine.h"
#include "tests/unit/flight/fat.h"

namespace fatmc::hidden_effect {
namespace {

constexpr int kPeriod = 500;

Eigen::MatrixX3d reference() {
  Eigen::MatrixX3d out(kPeriod, 3);
  RandomStream phases({1, name_hash("limit size test"), 0, 0}, "excitation");
  for (int axis = 0; axis < 3; ++axis) {
    const std::vector<double> r =
        Multisine::random_phase(kPeriod, {3, 5, 8, 13, 21}, 0.15, phases).samples(1);
    out.col(axis) = Eigen::Map<const Eigen::VectorXd>(r.data(), kPeriod);
  }
  return out;
}

/// Norm of the change of the rates in calm air, exact gyros.
double change(const std::vector<Effect>& effects) {
  const auto rates = [](const std::vector<Effect>& with) {
    const auto modified = apply(fat(), FlightSetup{}, with);
    FlightRecord flown;
    Flight::prepare(modified->aircraft, modified->setup)->fly(reference(), {}, flown);
    EXPECT_EQ(flown.ending, Ending::completed);
    return flown.output;
  };
  return (rates(effects) - rates({})).norm();
}

TEST(LimitSize, AQuarterOfALimitChangesTheRatesByAQuarter) {
  for (const char* text :
       {"rate_limit:surface=aileron,limit_deg_s=5", "position_limit:surface=ruddervator,limit_deg=0.5"}) {
    const Effect whole = *parse_effect(text);
    const Effect quarter = share_of_limit(whole, 0.25, fat(), FlightSetup{}, reference());
    ASSERT_GT(change({whole}), 0.0) << text;
    EXPECT_GT(quarter.values.front(), whole.values.front()) << text;
    EXPECT_NEAR(change({quarter}) / change({whole}), 0.25, 0.25 * LimitSearch::kTolerance) << text;
  }
}

TEST(LimitSize, MoreThanAllOfALimitIsATighterOne) {
  const Effect whole = *parse_effect("rate_limit:surface=aileron,limit_deg_s=5");
  const Effect more = share_of_limit(whole, 1.5, fat(), FlightSetup{}, reference());
  EXPECT_LT(more.values.front(), whole.values.front());
  EXPECT_NEAR(change({more}) / change({whole}), 1.5, 1.5 * LimitSearch::kTolerance);
}

TEST(LimitSize, LeavesWhatIsNoLimitAndLimitsThatNothingMeets) {
  const Effect delay = *parse_effect("transport_delay:delay_s=0.03");
  EXPECT_EQ(share_of_limit(delay, 0.25, fat(), FlightSetup{}, reference()), delay);
  const Effect far = *parse_effect("position_limit:surface=aileron,limit_deg=35");
  EXPECT_EQ(share_of_limit(far, 0.25, fat(), FlightSetup{}, reference()), far);
}

}  // namespace
}  // namespace fatmc::hidden_effect
