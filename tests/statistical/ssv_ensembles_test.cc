// How often the two bounds of the structured singular value meet, over ensembles of 3 × 3 plants, and whether
// the gaps that are left are real: D-scaling is exact for three blocks, a plant has nine.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <functional>
#include <numbers>

#include "core/robust/phase_problem.h"
#include "core/robust/structured_singular_value.h"
#include "core/stats/intervals.h"
#include "tests/unit/robust/random_plant.h"

namespace fatmc {
namespace {

using test::UncertainLoop;

constexpr int kPlants = 1000, kStarts = 200;

/// X complex normal with all radii equal.
UncertainLoop equal_radii(RandomStream& stream) {
  UncertainLoop out = test::random_loop(3, 3, stream);
  out.radii.setOnes();
  return out;
}

/// Best |λ| that climbing from random phases finds.
double search(const UncertainLoop& loop, RandomStream& stream) {
  const Eigen::Matrix3cd x = loop.x;
  const Eigen::Matrix3d w = loop.radii;
  const PhaseProblem<3, 3> problem(x, w);
  double best = 0.0;
  for (int start = 0; start < kStarts; ++start) {
    Eigen::Matrix<double, 6, 1> phases;
    for (int i = 0; i < 6; ++i) phases(i) = 2.0 * std::numbers::pi * stream.uniform();
    best = std::max(best, problem.climb(problem.evaluate(phases, 0.0, true), 1e-13, 60).rho);
  }
  return best;
}

struct Met {
  int plants = 0;        ///< on which the bounds meet to 1e-8
  int above = 0;         ///< misses on which the search finds more than the lower bound
  double worst_gap = 0;  ///< 1 - lower/upper
};

Met count(const char* name, const std::function<UncertainLoop(RandomStream&)>& draw) {
  Met out;
  for (int k = 0; k < kPlants; ++k) {
    RandomStream stream({21, 0, 0, static_cast<std::uint64_t>(k)}, name);
    const UncertainLoop loop = draw(stream);
    const SsvBounds bounds = structured_singular_value(loop.x, loop.radii);
    EXPECT_NE(bounds.status, SsvStatus::not_converged) << name << " " << k;
    if (bounds.certified()) {
      ++out.plants;
      continue;
    }
    out.worst_gap = std::max(out.worst_gap, 1.0 - bounds.lower / bounds.upper);
    out.above += search(loop, stream) > bounds.lower * (1.0 + 1e-8) ? 1 : 0;
  }
  const Interval share = proportion_interval(static_cast<std::uint64_t>(out.plants), kPlants);
  std::printf(
      "%-34s bounds meet on %5.1f %% (%.1f to %.1f), largest gap %.2g %%, search finds more on %d of %d "
      "misses\n",
      name, 100.0 * out.plants / kPlants, 100.0 * share.low, 100.0 * share.high, 100.0 * out.worst_gap,
      out.above, kPlants - out.plants);
  return out;
}

TEST(SsvEnsembles, TheGapsThatAreLeftAreReal) {
  const Met loops = count("feedback loops (I + K G)^-1 K",
                          [](RandomStream& s) { return test::random_feedback_loop(3, s); });
  const Met equal = count("X normal, radii equal", equal_radii);
  const Met half = count("X normal, radii log-normal 0.5",
                         [](RandomStream& s) { return test::random_loop(3, 3, s, 0.5); });
  const Met one =
      count("X normal, radii log-normal 1", [](RandomStream& s) { return test::random_loop(3, 3, s, 1.0); });
  const Met two =
      count("X normal, radii log-normal 2", [](RandomStream& s) { return test::random_loop(3, 3, s, 2.0); });
  for (const Met& met : {loops, equal, half, one, two}) {
    EXPECT_EQ(met.above, 0) << "the lower bound can be improved";
    EXPECT_LT(met.worst_gap, 0.1);
  }
  // What was measured when the solver was written: these notice a solver that grows worse, they are no bar set
  // beforehand. How often the bounds meet is a property of the ensemble, and none of them stands for aircraft.
  const auto as_measured = [](const Met& met, double share) {
    EXPECT_GE(met.plants, kPlants * share - 3.0 * std::sqrt(kPlants * share * (1.0 - share)));
  };
  as_measured(loops, 0.975);
  as_measured(equal, 0.896);
  as_measured(half, 0.920);
  as_measured(one, 0.950);
  as_measured(two, 0.982);
}

}  // namespace
}  // namespace fatmc
