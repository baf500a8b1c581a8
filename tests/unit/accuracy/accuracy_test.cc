#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "core/accuracy/response_accuracy.h"
#include "core/accuracy/series_accuracy.h"

namespace fatmc {
namespace {

using Complex = std::complex<double>;

TEST(ResponseError, IsZeroForTheSameResponseAndWrapsItsPhase) {
  const auto same = response_error({1.0, 2.0}, {1.0, 2.0}).value();
  EXPECT_NEAR(same.magnitude_db, 0.0, 1e-15);
  EXPECT_NEAR(same.phase_deg, 0.0, 1e-13);
  const auto turned = response_error(std::polar(2.0, 3.0), std::polar(1.0, -3.0)).value();
  EXPECT_NEAR(turned.magnitude_db, 20.0 * std::log10(2.0), 1e-13);
  EXPECT_NEAR(turned.phase_deg, (6.0 - 2.0 * std::numbers::pi) * 180.0 / std::numbers::pi, 1e-12);
}

TEST(ResponseError, RefusesAResponseOfZero) {
  EXPECT_FALSE(response_error(0.0, 1.0));
  EXPECT_FALSE(response_error(1.0, Complex(NAN, 0.0)));
}

TEST(ResponseCost, WeighsOneDecibelLike757Degrees) {
  const std::array<ResponseError, 2> db = {{{1.0, 0.0}, {0.0, 0.0}}};
  EXPECT_NEAR(response_cost(db), 10.0, 1e-12);  // 20/2 (1 + 0)
  const std::array<ResponseError, 1> one = {{{1.0, 0.0}}}, phase = {{{0.0, 7.57}}};
  EXPECT_NEAR(response_cost(phase) / response_cost(one), 1.0, 1e-3);
}

TEST(UnnoticedDynamics, HasTheKnownLimitsAtOneRadianASecond) {
  const UnnoticedDynamics limit = unnoticed_dynamics(0.5 / std::numbers::pi);
  EXPECT_NEAR(limit.upper_db, 2.7, 0.05);
  EXPECT_NEAR(limit.lower_db, -1.7, 0.05);
  EXPECT_NEAR(limit.upper_deg, 30.0, 0.5);
  EXPECT_NEAR(limit.lower_deg, -14.0, 0.5);
}

TEST(UnnoticedDynamics, HoldsNoErrorAtAllFrequenciesAndIsTightestInTheMiddle) {
  for (double f = 0.02; f < 3.0; f *= 1.1) {
    EXPECT_TRUE(unnoticed({0.0, 0.0}, f)) << f;
    EXPECT_FALSE(unnoticed({40.0, 0.0}, f)) << f;
    EXPECT_FALSE(unnoticed({0.0, -170.0}, f)) << f;
  }
  const auto width = [](double f) { return unnoticed_dynamics(f).upper_db - unnoticed_dynamics(f).lower_db; };
  EXPECT_LT(width(0.3), width(0.02));
  EXPECT_LT(width(0.3), width(3.0));
}

const std::array<double, 4> kMeasured = {1.0, -1.0, 2.0, -2.0};

TEST(TheilCoefficient, IsZeroForAMatchAndOneForTheOpposite) {
  std::array<double, 4> opposite{};
  for (std::size_t k = 0; k < 4; ++k) opposite[k] = -kMeasured[k];
  EXPECT_EQ(theil_coefficient(kMeasured, kMeasured), 0.0);
  EXPECT_NEAR(*theil_coefficient(kMeasured, opposite), 1.0, 1e-15);
  EXPECT_FALSE(theil_coefficient(std::array{0.0, 0.0}, std::array{0.0, 0.0}));
}

TEST(IndexOfAgreement, IsOneForAMatchAndZeroForTheOpposite) {
  std::array<double, 4> opposite{}, shifted{}, shifted_both{};
  for (std::size_t k = 0; k < 4; ++k) {
    opposite[k] = -kMeasured[k];
    shifted[k] = kMeasured[k] + 7.0;
    shifted_both[k] = 0.5 * kMeasured[k] + 7.0;
  }
  EXPECT_EQ(index_of_agreement(kMeasured, kMeasured), 1.0);
  EXPECT_NEAR(*index_of_agreement(kMeasured, opposite), 0.0, 1e-15);
  std::array<double, 4> half{};
  for (std::size_t k = 0; k < 4; ++k) half[k] = 0.5 * kMeasured[k];
  // |m - m/2| = |m|/2 against |m| + |m|/2: 1 - 1/3, whatever offset both carry.
  EXPECT_NEAR(*index_of_agreement(kMeasured, half), 2.0 / 3.0, 1e-15);
  EXPECT_NEAR(*index_of_agreement(shifted, shifted_both), 2.0 / 3.0, 1e-15);
  EXPECT_FALSE(index_of_agreement(std::array{1.0, 1.0}, std::array{1.0, 1.0}));
}

TEST(IndexOfAgreement, IsZeroOverallWhereOneOutputIs) {
  EXPECT_EQ(overall_index_of_agreement(std::array{1.0, 0.0, 0.9}), 0.0);
  EXPECT_NEAR(overall_index_of_agreement(std::array{0.81, 1.0}), 0.9, 1e-15);
}

TEST(IndexOfAgreement, CountsAnOutputByItsWeight) {
  const std::array d = {0.81, 0.64};
  EXPECT_EQ(overall_index_of_agreement(d, std::array{1.0, 1.0}), overall_index_of_agreement(d));
  // H (11) by hand: 0.81^(2/2) 0.64^(0/2) and 0.81^(1/4) 0.64^(3/4) with 0.81^(1/4) = sqrt(0.9), 0.64^(3/4) = 0.8^(3/2).
  EXPECT_NEAR(overall_index_of_agreement(d, std::array{2.0, 0.0}), 0.81, 1e-15);
  EXPECT_NEAR(overall_index_of_agreement(d, std::array{0.5, 1.5}), std::sqrt(0.9 * 0.8 * 0.8 * 0.8), 1e-15);
  EXPECT_NEAR(overall_index_of_agreement(std::array{0.0, 0.81}, std::array{0.0, 1.0}), 0.9, 1e-15);
}

}  // namespace
}  // namespace fatmc
