// What becomes of rows when the disk is full, broken or loses power: what was committed is there, of the rest
// nothing is, and the store goes on when it can.
#include <SQLiteCpp/SQLiteCpp.h>
#include <gtest/gtest.h>
#include <sqlite3.h>

#include <fstream>
#include <random>

#include "tests/support/fault_vfs.h"
#include "tests/unit/store/example_rows.h"

namespace fatmc {
namespace {

namespace fs = std::filesystem;

class StorageFaults : public StoreFolder {
 protected:
  FaultVfs vfs_;
};

TEST_F(StorageFaults, ACommitThatFailsStoresNothingAndTheNextOneWorks) {
  auto store = CampaignStore::open(path_, example_spec(), "build");
  ASSERT_TRUE(store);
  store->commit(std::vector{request({example_row(0, 0, 1.0)})});
  ComputedRow fresh = example_row(0, 1, 2.0);
  fresh.row.metrics.emplace_back("a name that the file does not have", 3.0);
  fresh.hash = content_hash(fresh.row);
  const std::vector<StoreRequest> batch{request({fresh, example_row(1, 1, 3.0)})};
  for (const auto& [write, sync] :
       {std::pair{SQLITE_FULL, 0}, {SQLITE_IOERR_WRITE, 0}, {0, SQLITE_IOERR_FSYNC}}) {
    vfs_.write_code = write;
    vfs_.sync_code = sync;
    for (int again = 0; again < 3; ++again) EXPECT_THROW(store->commit(batch), StorageTrouble);
    EXPECT_EQ(CampaignReader::open(path_)->stored(), 1U);
  }
  vfs_.write_code = vfs_.sync_code = 0;
  const auto reports = store->commit(batch);
  EXPECT_EQ(reports.at(0).rows.at(0).second, StoreOutcome::stored);
  EXPECT_EQ(reports.at(0).rows.at(1).second, StoreOutcome::stored);
  const auto reader = CampaignReader::open(path_);
  EXPECT_EQ(reader->stored(), 3U);
  bool found = false;
  reader->visit(0, [&](const TrialRow& row) {
    if (row.key.repetition != 1) return;
    found = true;
    EXPECT_EQ(content_hash(row), fresh.hash) << "names of the transactions that failed are known as stored";
  });
  EXPECT_TRUE(found);
}

TEST_F(StorageFaults, APowerCutAtAnyMomentLosesNoCommittedRow) {
  struct Cut {
    std::map<std::string, std::string> files;
    std::uint64_t committed;  // rows that were acknowledged by then
  };
  std::vector<Cut> cuts;
  std::uint64_t committed = 0;
  std::mt19937_64 random(1);
  {
    auto store = CampaignStore::open(path_, example_spec(1, 2000), "build");
    ASSERT_TRUE(store);
    // Anywhere inside commits and checkpoints: at about 60 of the writes and syncs.
    vfs_.before = [&] {
      if (random() % 60 == 0) cuts.push_back({vfs_.synced, committed});
    };
    for (std::uint64_t i = 0; i < 300; ++i) {
      store->commit(std::vector{request({example_row(0, i, 1.0), example_row(1, i, 2.0)})});
      committed += 2;
    }
    vfs_.before = nullptr;
    cuts.push_back({vfs_.synced, committed});
  }
  ASSERT_GT(cuts.size(), 20U);
  for (const Cut& cut : cuts) {
    const fs::path after = folder_ / "after";
    fs::remove_all(after);
    fs::create_directories(after);
    for (const auto& [path, content] : cut.files)
      std::ofstream(after / fs::path(path).filename(), std::ios::binary) << content;
    const std::string database = (after / fs::path(path_).filename()).string();
    auto reopened = CampaignStore::open(database, example_spec(1, 2000), "build");
    ASSERT_TRUE(reopened) << reopened.error().text();
    std::uint64_t stored = 0;
    for (const PlanCell& cell : reopened->plan(example_spec(1, 2000))) stored += cell.stored.size();
    EXPECT_GE(stored, cut.committed);
    EXPECT_LE(stored, cut.committed + 2) << "one commit may be on disk and not yet acknowledged";
    const auto reader = CampaignReader::open(database);
    SQLite::Statement check(reader->database(), "PRAGMA integrity_check");
    ASSERT_TRUE(check.executeStep());
    EXPECT_EQ(check.getColumn(0).getString(), "ok");
  }
}

TEST_F(StorageFaults, AResultTakesThePlaceOfARowThatSaysItsTrialWasGivenUp) {
  auto store = CampaignStore::open(path_, example_spec(), "build");
  ComputedRow given_up;
  given_up.row.key = {0, 4};
  given_up.row.outcome = kQuarantined;
  given_up.row.detail = "killed its worker 3 times, at last: signal Killed";
  given_up.hash = content_hash(given_up.row);
  const auto outcome = [&](const ComputedRow& row) {
    return store->commit(std::vector{request({row})}).at(0).rows.at(0).second;
  };
  EXPECT_EQ(outcome(given_up), StoreOutcome::stored);
  EXPECT_EQ(store->plan(example_spec()).at(0).stored.size(), 1U);
  EXPECT_EQ(store->plan(example_spec(), StoredTrials::results).at(0).stored.size(), 0U)
      << "it may be tried again";
  ComputedRow again = given_up;
  again.row.detail = "killed its worker 3 times, at last: exit code 1";
  again.hash = content_hash(again.row);
  EXPECT_EQ(outcome(again), StoreOutcome::duplicate)
      << "given up for another reason is no conflict of results";
  const ComputedRow real = example_row(0, 4, 1.0);
  EXPECT_EQ(outcome(real), StoreOutcome::stored);
  EXPECT_EQ(outcome(given_up), StoreOutcome::duplicate) << "never the other way round";
  EXPECT_EQ(CampaignReader::open(path_)->stored(), 1U);
  CampaignReader::open(path_)->visit(0,
                                     [&](const TrialRow& row) { EXPECT_EQ(content_hash(row), real.hash); });
}

}  // namespace
}  // namespace fatmc
