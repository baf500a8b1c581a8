// The joint law against special cases in closed form; statistical checks stand in unit_ident and
// tests/validation.
#include "core/stats/confidence_regions.h"

#include <gtest/gtest.h>

#include <boost/math/distributions/fisher_f.hpp>
#include <boost/math/distributions/gamma.hpp>
#include <cmath>

#include "core/stats/confidence.h"
#include "core/stats/lawley_hotelling.h"

namespace fatmc {
namespace {

double f_cdf(double x, double m, double n) { return boost::math::cdf(boost::math::fisher_f(m, n), x); }

TEST(LawleyHotelling, IsTheDiscsLawForOneElement) {
  for (const double q : {1.0, 4.0, 10.0, 1000.0}) {
    const ComplexLawleyHotelling law(1, 1, q);
    for (const double t : {0.1, 1.0, 3.5, 20.0})
      EXPECT_NEAR(law.distribution(t).value, f_cdf_2_2q(t, q), 1e-11) << q << " " << t;
  }
}

TEST(LawleyHotelling, IsHotellingsForOneInput) {
  for (const int n : {2, 3, 6}) {
    for (const double q : {6.0, 10.0, 50.0}) {
      const ComplexLawleyHotelling law(n, 1, q);
      for (const double t : {1.0, 5.0, 25.0}) {
        EXPECT_NEAR(law.distribution(t).value,
                    f_cdf(t * (q - n + 1.0) / (n * q), 2.0 * n, 2.0 * (q - n + 1.0)), 1e-11);
      }
    }
  }
}

TEST(LawleyHotelling, IsFForOneOutput) {
  const ComplexLawleyHotelling law(1, 4, 7.0);
  for (const double t : {1.0, 5.0, 25.0})
    EXPECT_NEAR(law.distribution(t).value, f_cdf(t / 4.0, 8.0, 14.0), 1e-11);
}

TEST(LawleyHotelling, TendsToTheChiSquareOfKnownNoise) {
  // T^2 -> gamma(n_out n_in) with corrections of order 1/q.
  const double known = boost::math::cdf(boost::math::gamma_distribution<>(9.0), 9.0);
  const double at_1e3 = ComplexLawleyHotelling(3, 3, 1e3).distribution(9.0).value - known;
  const double at_1e4 = ComplexLawleyHotelling(3, 3, 1e4).distribution(9.0).value - known;
  EXPECT_LT(std::abs(at_1e4), 1e-3);
  EXPECT_NEAR(at_1e3 / at_1e4, 10.0, 0.1);
}

TEST(LawleyHotelling, GivesTheLimitOfThreeByThree) {
  const ComplexLawleyHotelling law(3, 3, 10.0);
  const auto limit = law.quantile(0.95);
  EXPECT_NEAR(limit.value, 24.3364,
              5e-5);  // tests/validation/joint_region_reference.py, by quadrature of scipy
  EXPECT_LT(limit.error, 1e-9);
  EXPECT_NEAR(law.distribution(limit.value).value, 0.95, 1e-11);
  EXPECT_NEAR(printed_joint_limit(0.95, 3, 3, 10.0), 262.0, 0.5);
}

TEST(LawleyHotelling, ItsErrorEstimateCoversTheDifferenceToClosedForms) {
  for (const double t : {0.5, 3.0, 30.0, 300.0}) {
    const auto value = ComplexLawleyHotelling(1, 1, 10.0).distribution(t);
    EXPECT_LE(std::abs(value.value - f_cdf_2_2q(t, 10.0)), 10.0 * value.error) << t;
  }
}

TEST(RegionRadius, GrowsFromOneElementToAllToEveryCombination) {
  for (const double p : {0.75, 0.95, 0.99}) {
    const double one = *region_radius(RegionKind::univariate, p, 3, 3, 10.0);
    const double all = *region_radius(RegionKind::bonferroni, p, 3, 3, 10.0);
    const double every = *region_radius(RegionKind::simultaneous, p, 3, 3, 10.0);
    EXPECT_LT(one, all);
    EXPECT_LT(all, every);
    EXPECT_EQ(every, *region_radius(RegionKind::joint, p, 3, 3, 10.0));
  }
  EXPECT_NEAR(*region_radius(RegionKind::joint, 0.9, 1, 1, 5.0),
              *region_radius(RegionKind::univariate, 0.9, 1, 1, 5.0), 1e-10);
}

TEST(RegionRadius, HasNoJointRegionWhereTheCovarianceEstimateIsSingular) {
  EXPECT_FALSE(region_radius(RegionKind::joint, 0.95, 3, 3, 2.0));
  EXPECT_TRUE(region_radius(RegionKind::bonferroni, 0.95, 3, 3, 2.0));
}

}  // namespace
}  // namespace fatmc
