// Upper bound of the structured singular value against SLICOT's AB13MD on the whole 9 × 9 loop matrix.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/robust/loop_matrix.h"
#include "core/robust/structured_singular_value.h"
#include "tests/support/slicot.h"
#include "tests/unit/robust/random_plant.h"

namespace fatmc {
namespace {

struct Agreement {
  double above = 0.0;  // largest relative excess of ours over AB13MD's
  double below = 0.0;  // and of AB13MD's over ours
  int met = 0;
  int peer_failed = 0;
};

template <typename Make>
Agreement compare(int plants, Make make) {
  Agreement out;
  for (int k = 0; k < plants; ++k) {
    RandomStream stream({7, 0, 0, static_cast<std::uint64_t>(k)}, "plant");
    const test::UncertainLoop loop = make(k, stream);
    const SsvBounds ours = structured_singular_value(loop.x, loop.radii);
    const Eigen::MatrixXcd m = uncertainty_loop(loop.x, loop.radii);
    test::SlicotSsv peer(static_cast<int>(m.rows()));
    const auto theirs = peer.upper_bound(m);
    if (theirs.info != 0) {
      ++out.peer_failed;
      continue;
    }
    out.above = std::max(out.above, ours.upper / theirs.bound - 1.0);
    out.below = std::max(out.below, theirs.bound / ours.upper - 1.0);
    out.met += ours.certified() ? 1 : 0;
  }
  std::printf("%d plants: above AB13MD by at most %.2e, below by at most %.2e, bounds met %d, AB13MD failed %d\n",
              plants, out.above, out.below, out.met, out.peer_failed);
  return out;
}

TEST(SsvAgainstSlicot, RandomLoopsAgreeAndAreNeverAbove) {
  const Agreement out = compare(300, [](int, RandomStream& s) { return test::random_loop(3, 3, s); });
  EXPECT_LE(out.above, 1e-8);
  EXPECT_LE(out.below, 1e-6);  // AB13MD stops by its own tolerance
  EXPECT_EQ(out.peer_failed, 0);
}

TEST(SsvAgainstSlicot, FeedbackLoopsAgreeAndAreNeverAbove) {
  const Agreement out = compare(300, [](int, RandomStream& s) { return test::random_feedback_loop(3, s); });
  EXPECT_LE(out.above, 1e-8);
  EXPECT_LE(out.below, 1e-6);
  EXPECT_EQ(out.peer_failed, 0);
}

TEST(SsvAgainstSlicot, OtherSizesAgreeAndAreNeverAbove) {
  const Agreement out = compare(60, [](int k, RandomStream& s) {
    return test::random_loop(1 + k % 4, 1 + k / 4 % 3, s);
  });
  EXPECT_LE(out.above, 1e-8);
  EXPECT_LE(out.below, 1e-6);
  EXPECT_EQ(out.peer_failed, 0);
}

}  // namespace
}  // namespace fatmc
