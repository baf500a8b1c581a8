#include "coordinator/state/index_ranges.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

namespace fatmc {
namespace {

TEST(IndexRanges, BehavesAsASetOfNumbersUnderRandomInsertionsAndErasures) {
  std::mt19937_64 random(1);
  for (int round = 0; round < 20; ++round) {
    IndexRanges ranges;
    std::set<std::uint64_t> model;
    for (int step = 0; step < 300; ++step) {
      const std::uint64_t first = random() % 60, last = first + random() % 12;
      if (random() % 2 == 0) {
        ranges.insert(first, last);
        for (std::uint64_t i = first; i < last; ++i) model.insert(i);
      } else {
        ranges.erase(first, last);
        for (std::uint64_t i = first; i < last; ++i) model.erase(i);
      }
      ASSERT_EQ(ranges.size(), model.size());
      for (std::uint64_t i = 0; i < 75; ++i) ASSERT_EQ(ranges.contains(i), model.contains(i)) << i;
      std::uint64_t end = 0;
      bool is_first = true;
      for (const auto& [low, high] : ranges.ranges()) {
        ASSERT_LT(low, high);
        if (!is_first) {
          ASSERT_GT(low, end) << "neighbours must be one range";
        }
        is_first = false;
        end = high;
      }
    }
  }
}

TEST(IndexRanges, TakesNeighboursFromTheFront) {
  IndexRanges ranges;
  ranges.insert(2, 5);
  ranges.insert(7, 20);
  EXPECT_EQ(ranges.take(2), (std::pair<std::uint64_t, std::uint64_t>(2, 4)));
  EXPECT_EQ(ranges.take(9), (std::pair<std::uint64_t, std::uint64_t>(4, 5)));
  EXPECT_EQ(ranges.take(9), (std::pair<std::uint64_t, std::uint64_t>(7, 16)));
  EXPECT_EQ(ranges.size(), 4U);
}

}  // namespace
}  // namespace fatmc
