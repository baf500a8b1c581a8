// How many pilots there should be.
#include "coordinator/launch/pilot_plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fatmc {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

std::vector<QueuedPilot> queue(int running, int pending) {
  std::vector<QueuedPilot> out;
  for (int i = 0; i < running; ++i) out.push_back({"r" + std::to_string(i), false});
  for (int i = 0; i < pending; ++i) out.push_back({"p" + std::to_string(i), true});
  return out;
}

TEST(Queue, LeavesOutJobsThatAreEnding) {
  EXPECT_THAT(
      parse_queue("12 RUNNING\n13_1 PENDING\n13_2 COMPLETING\n14 CANCELLED\n15 REQUEUE_HOLD\n16 SUSPENDED\n"),
      ElementsAre(QueuedPilot{"12", false}, QueuedPilot{"13_1", true}, QueuedPilot{"15", true},
                  QueuedPilot{"16", false}));
  EXPECT_THAT(parse_queue(""), IsEmpty());
}

TEST(Pilots, AreSubmittedUpToWhatWasAskedFor) {
  EXPECT_EQ(decide_pilots({}, {1000, 0, 0}, 8, 1).submit, 8U);
  EXPECT_EQ(decide_pilots(queue(2, 3), {1000, 0, 2}, 8, 1).submit, 3U);
  EXPECT_EQ(decide_pilots(queue(5, 3), {1000, 0, 5}, 8, 1), PilotAction{});
}

TEST(Pilots, AreNoMoreThanTheTrialsThatAreLeft) {
  EXPECT_EQ(decide_pilots({}, {3, 0, 0}, 8, 1).submit, 3U);
  EXPECT_EQ(decide_pilots({}, {9, 0, 0}, 8, 4).submit, 3U) << "9 trials on pilots of 4 at a time";
  EXPECT_EQ(decide_pilots({}, {0, 0, 0}, 8, 1), PilotAction{});
}

TEST(Pilots, ThatWaitAreCancelledWhenTheyAreNotNeededAnyMoreTheYoungestFirst) {
  EXPECT_THAT(decide_pilots(queue(2, 3), {3, 0, 2}, 8, 1).cancel, ElementsAre("p2", "p1"));
}

TEST(Pilots, ThatRunAreNeverCancelled) {
  EXPECT_EQ(decide_pilots(queue(6, 0), {2, 0, 6}, 8, 1), PilotAction{});
}

TEST(Pilots, ThatNoQueueKnowsAreCountedByTheirConnection) {
  EXPECT_EQ(decide_pilots({}, {1000, 0, 5}, 8, 1).submit, 3U) << "a controller that lost its memory";
  EXPECT_EQ(decide_pilots(queue(3, 0), {1000, 0, 1}, 8, 1).submit, 5U) << "two are still starting";
}

TEST(Pilots, AreMistrustedWhenTheyEndInVain) {
  PilotTrust trust;
  for (int i = 0; i < 7; ++i) trust.submitted(2, 0);
  EXPECT_TRUE(trust.lost(2));
  trust.submitted(2, 1);  // one trial was stored since
  EXPECT_FALSE(trust.lost(2));
}

}  // namespace
}  // namespace fatmc
