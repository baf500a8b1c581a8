// Shards of one campaign, joined.
#include "coordinator/store/shard_merge.h"

#include <SQLiteCpp/SQLiteCpp.h>

#include "coordinator/store/schema.h"
#include "tests/unit/store/example_rows.h"

namespace fatmc {
namespace {

class ShardMerge : public StoreFolder {
 protected:
  std::string make(const std::string& name, std::vector<ComputedRow> rows,
                   const CampaignSpec& spec = example_spec(), const char* build = "build") const {
    auto store = CampaignStore::open(file(name), spec, build);
    EXPECT_TRUE(store) << store.error().text();
    store->commit(std::vector{request(std::move(rows))});
    return file(name);
  }
  static std::string digest(const std::string& path) { return CampaignReader::open(path)->digest(); }
};

std::vector<ComputedRow> rows(std::uint64_t first, std::uint64_t last) {
  std::vector<ComputedRow> out;
  for (std::uint32_t cell = 0; cell < 2; ++cell)
    for (std::uint64_t i = first; i < last; ++i)
      out.push_back(example_row(cell, i, 0.1 * static_cast<double>(i)));
  return out;
}

TEST_F(ShardMerge, HasTheDigestOfASingleRunAndTakesOverlapsOnce) {
  const std::string whole = make("whole.db", rows(0, 10));
  const std::string a = make("a.db", rows(0, 6)), b = make("b.db", rows(4, 10));
  const auto report = merge_shards(file("out.db"), {b, a});
  ASSERT_TRUE(report) << report.error().text();
  EXPECT_EQ(report->added, 20U);
  EXPECT_EQ(report->duplicates, 4U);
  EXPECT_EQ(report->stored, 20U);
  EXPECT_EQ(report->planned, 20U);
  EXPECT_EQ(digest(file("out.db")), digest(whole));
}

TEST_F(ShardMerge, KeepsHostsTimesAndAttempts) {
  const std::string a = make("a.db", rows(0, 1));
  SQLite::Database(a, SQLite::OPEN_READWRITE)
      .exec("UPDATE trial SET host = 'far', attempts = 3, started_us = 77");
  ASSERT_TRUE(merge_shards(file("out.db"), {a}));
  SQLite::Database db(file("out.db"));
  EXPECT_EQ(
      db.execAndGet("SELECT count(*) FROM trial WHERE host = 'far' AND attempts = 3 AND started_us = 77 "
                    "AND pid = 7 AND duration_ns = 1000")
          .getInt(),
      2);
}

TEST_F(ShardMerge, AddsToADatabaseThatExistsAndPlansTheMostRepetitions) {
  const std::string a = make("a.db", rows(0, 3), example_spec(1, 3)),
                    b = make("b.db", rows(3, 5), example_spec(1, 5));
  ASSERT_TRUE(merge_shards(a, {b}));
  EXPECT_EQ(CampaignReader::open(a)->spec().trial_count(), 10U);
  EXPECT_EQ(digest(a), digest(make("whole.db", rows(0, 5))));
}

TEST_F(ShardMerge, TwoResultsOfOneTrialAreAnAlarmAndChangeNothing) {
  const std::string a = make("a.db", rows(0, 5));
  const std::string b = make("b.db", {example_row(1, 7, 0.0), example_row(0, 3, 99.0)});
  const std::string before = digest(a);
  const auto refused = merge_shards(a, {b});
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().text().find("ALARM: trial 3 of cell \"a\" has another result"), std::string::npos)
      << refused.error().text();
  EXPECT_EQ(digest(a), before);
  EXPECT_FALSE(merge_shards(file("new.db"), {a, b}));
  EXPECT_FALSE(std::filesystem::exists(file("new.db")));
}

TEST_F(ShardMerge, ARowThatDoesNotMatchItsHashIsRefused) {
  const std::string a = make("a.db", rows(0, 5));
  SQLite::Database(a, SQLite::OPEN_READWRITE)
      .exec("UPDATE metric SET value = 8.5 WHERE trial = 2 AND position = 0");
  const auto refused = merge_shards(file("new.db"), {a});
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().text().find("trial 2 of cell \"a\" does not match"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(file("new.db")));
}

TEST_F(ShardMerge, OtherCampaignsAndTheOutputItselfAreRefused) {
  const std::string a = make("a.db", rows(0, 1)), seed = make("s.db", {}, example_spec(2)),
                    amplitude = make("m.db", {}, example_spec(1, 10, 0.5)),
                    build = make("b.db", {}, example_spec(), "another");
  for (const std::string& other : {seed, amplitude, build}) {
    const auto refused = merge_shards(file("new.db"), {a, other});
    ASSERT_FALSE(refused) << other;
    EXPECT_EQ(refused.error().file, other);
    EXPECT_FALSE(std::filesystem::exists(file("new.db")));
  }
  EXPECT_FALSE(merge_shards(a, {a}));
  EXPECT_FALSE(merge_shards(file("new.db"), {a, file("none.db")}));
}

TEST_F(ShardMerge, AStoreGoesOnAfterATransactionThatWasTakenBack) {
  auto store = CampaignStore::open(path_, example_spec(), "build");
  ASSERT_TRUE(store);
  store->atomically([&] {
    store->commit(std::vector{request({example_row(0, 0, 1.0)})});
    return false;
  });
  EXPECT_EQ(CampaignReader::open(path_)->stored(), 0U);
  store->commit(std::vector{request({example_row(0, 0, 2.0)})});
  const auto reader = CampaignReader::open(path_);
  reader->visit(0, [](const TrialRow& row) { EXPECT_EQ(row.metrics.at(0).second, 2.0); });
  EXPECT_EQ(reader->stored(), 1U);
}

}  // namespace
}  // namespace fatmc
