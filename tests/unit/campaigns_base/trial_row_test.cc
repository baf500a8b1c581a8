#include "campaigns/base/trial_row.h"

#include <gtest/gtest.h>

#include <cmath>

namespace fatmc {
namespace {

TrialRow example() {
  TrialRow row;
  row.key = {0, 3};
  row.metrics = {{"snr", 20.5}};
  row.arrays = {{"re", {1.0, 2.0}}, {"im", {3.0}}};
  return row;
}

TEST(ContentHash, ChangesWithEveryBitOfTheResult) {
  const Sha256 base = content_hash(example());
  EXPECT_EQ(base, content_hash(example()));
  TrialRow row = example();
  row.arrays[0].second[1] = std::nextafter(2.0, 3.0);
  EXPECT_NE(base, content_hash(row));
  row = example();
  row.arrays = {{"re", {1.0}}, {"im", {2.0, 3.0}}};
  EXPECT_NE(base, content_hash(row));
  row = example();
  row.outcome = "diverged";
  EXPECT_NE(base, content_hash(row));
  row = example();
  row.key.repetition = 4;
  EXPECT_NE(base, content_hash(row));
}

TEST(Sha256, GivesThePublishedKnownAnswer) {  // FIPS 180-2, appendix B.1
  EXPECT_EQ(hex(sha256("abc")), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

}  // namespace
}  // namespace fatmc
