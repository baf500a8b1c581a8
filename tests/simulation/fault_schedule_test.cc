// Four thousand random fault schedules. A failure names its seed; FATMC_SIMULATION_SEED=N replays that one
// alone.
#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/simulation/simulated_campaign.h"

namespace fatmc::simulation {
namespace {

constexpr std::uint64_t kSchedulesAPart = 500;

void report(std::uint64_t seed, const History& history) {
  for (const std::string& violation : history.violations)
    ADD_FAILURE() << "FATMC_SIMULATION_SEED=" << seed << ": " << violation;
}

class FaultSchedules : public testing::TestWithParam<std::uint64_t> {};

TEST_P(FaultSchedules, LoseNothingStoreNothingTwiceAndEndWithTheDigestOfAFaultFreeRun) {
  if (const char* seed = std::getenv("FATMC_SIMULATION_SEED")) {
    report(std::stoull(seed), SimulatedCampaign(std::stoull(seed)).run());
    return;
  }
  History sum;
  for (std::uint64_t i = 0; i < kSchedulesAPart; ++i) {
    const std::uint64_t seed = GetParam() * kSchedulesAPart + i;
    const History history = SimulatedCampaign(seed).run();
    report(seed, history);
    sum.worker_deaths += history.worker_deaths;
    sum.coordinator_deaths += history.coordinator_deaths;
    sum.failed_commits += history.failed_commits;
    sum.power_cuts += history.power_cuts;
    sum.messages_lost += history.messages_lost;
    sum.copies += history.copies;
    sum.duplicates += history.duplicates;
    sum.quarantined += history.quarantined;
  }
  std::printf(
      "%llu schedules: %llu worker deaths, %llu coordinator deaths, %llu power cuts, %llu failed commits, "
      "%llu messages lost, %llu copies, %llu duplicate rows, %llu trials given up\n",
      static_cast<unsigned long long>(kSchedulesAPart), static_cast<unsigned long long>(sum.worker_deaths),
      static_cast<unsigned long long>(sum.coordinator_deaths),
      static_cast<unsigned long long>(sum.power_cuts), static_cast<unsigned long long>(sum.failed_commits),
      static_cast<unsigned long long>(sum.messages_lost), static_cast<unsigned long long>(sum.copies),
      static_cast<unsigned long long>(sum.duplicates), static_cast<unsigned long long>(sum.quarantined));
  // Schedules without faults would prove nothing.
  EXPECT_GT(sum.worker_deaths, 100U);
  EXPECT_GT(sum.coordinator_deaths, 50U);
  EXPECT_GT(sum.power_cuts, 10U);
  EXPECT_GT(sum.failed_commits, 100U);
  EXPECT_GT(sum.copies, 50U);
  EXPECT_GT(sum.duplicates, 100U);
  EXPECT_GT(sum.quarantined, 5U);
}

INSTANTIATE_TEST_SUITE_P(Seeds, FaultSchedules, testing::Range<std::uint64_t>(0, 8));

TEST(FaultSchedule, IsAFunctionOfItsSeed) {
  for (const std::uint64_t seed : {3U, 17U}) {
    const History one = SimulatedCampaign(seed).run(), two = SimulatedCampaign(seed).run();
    EXPECT_EQ(one.steps, two.steps);
    EXPECT_EQ(one.messages_lost, two.messages_lost);
    EXPECT_EQ(one.duplicates, two.duplicates);
  }
}

}  // namespace
}  // namespace fatmc::simulation
