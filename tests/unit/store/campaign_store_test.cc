#include "coordinator/store/campaign_store.h"

#include <SQLiteCpp/SQLiteCpp.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <optional>

#include "coordinator/store/spec_difference.h"
#include "coordinator/store/writer_lock.h"
#include "tests/unit/store/example_rows.h"

namespace fatmc {
namespace {

class Store : public StoreFolder {};

TEST_F(Store, RowsComeBackBitForBitInTheOrderOfTheirKeys) {
  const CampaignSpec spec = example_spec();
  const std::vector<ComputedRow> rows = {example_row(1, 3, 0.1), example_row(0, 9, std::nan("7")),
                                         example_row(1, 0, 1e-310), example_row(0, 2, -3.0)};
  auto store = CampaignStore::open(path_, spec, "build");
  ASSERT_TRUE(store);
  store->commit(std::vector{request(rows)});
  const auto reader = CampaignReader::open(path_);
  ASSERT_TRUE(reader);
  std::vector<std::pair<TrialKey, Sha256>> seen;
  for (std::uint32_t cell = 0; cell < 2; ++cell) {
    reader->rows()(cell, [&](const TrialRow& row) { seen.emplace_back(row.key, content_hash(row)); });
  }
  const std::vector<std::pair<TrialKey, Sha256>> expected = {
      {{0, 2}, rows[3].hash}, {{0, 9}, rows[1].hash}, {{1, 0}, rows[2].hash}, {{1, 3}, rows[0].hash}};
  EXPECT_EQ(seen, expected);
}

TEST_F(Store, VisitsMayNest) {
  auto store = CampaignStore::open(path_, example_spec(), "build");
  store->commit(
      std::vector{request({example_row(0, 0, 1.0), example_row(0, 1, 2.0), example_row(1, 0, 3.0)})});
  const auto reader = CampaignReader::open(path_);
  int pairs = 0;
  reader->visit(0, [&](const TrialRow&) { reader->visit(1, [&](const TrialRow&) { ++pairs; }); });
  EXPECT_EQ(pairs, 2);
}

TEST_F(Store, ASecondRowOfATrialIsADuplicateOrAConflictAndNeverOverwrites) {
  auto store = CampaignStore::open(path_, example_spec(), "build");
  const auto outcome = [&](const ComputedRow& row) {
    return store->commit(std::vector{request({row})}).at(0).rows.at(0).second;
  };
  EXPECT_EQ(outcome(example_row(0, 1, 1.0)), StoreOutcome::stored);
  EXPECT_EQ(outcome(example_row(0, 1, 1.0)), StoreOutcome::duplicate);
  EXPECT_EQ(outcome(example_row(0, 1, 2.0)), StoreOutcome::conflict);
  const auto reader = CampaignReader::open(path_);
  EXPECT_EQ(reader->stored(), 1U);
  reader->visit(0, [](const TrialRow& row) { EXPECT_EQ(row.metrics.at(0).second, 1.0); });
}

TEST_F(Store, TheDigestKnowsResultsAndNeitherOrderNorProvenance) {
  const std::string other = (folder_ / "d.db").string();
  {
    auto store = CampaignStore::open(path_, example_spec(), "build");
    store->commit(std::vector{request({example_row(0, 1, 1.0), example_row(1, 1, 2.0)})});
    auto second = CampaignStore::open(other, example_spec(), "build");
    StoreRequest late = request({example_row(1, 1, 2.0)});
    late.host = "elsewhere";
    late.attempts = {3};
    late.rows[0].started_us = 5;
    second->commit(std::vector{late, request({example_row(0, 1, 1.0)})});
  }
  EXPECT_EQ(CampaignReader::open(path_)->digest(), CampaignReader::open(other)->digest());
  {
    auto store = CampaignStore::open(other, example_spec(), "build");
    store->commit(std::vector{request({example_row(0, 2, 1.0)})});
  }
  EXPECT_NE(CampaignReader::open(path_)->digest(), CampaignReader::open(other)->digest());
}

TEST_F(Store, ReopeningKnowsWhatIsStoredAndExtends) {
  {
    auto store = CampaignStore::open(path_, example_spec(), "build");
    store->commit(
        std::vector{request({example_row(0, 0, 1.0), example_row(0, 1, 1.0), example_row(0, 5, 1.0)})});
  }
  const CampaignSpec more = example_spec(1, 20);
  auto store = CampaignStore::open(path_, more, "build");
  ASSERT_TRUE(store) << store.error().text();
  const std::vector<PlanCell> plan = store->plan(more);
  EXPECT_EQ(plan[0].repetitions, 20U);
  EXPECT_EQ(plan[0].stored.ranges(), (std::map<std::uint64_t, std::uint64_t>{{0, 2}, {5, 6}}));
  EXPECT_TRUE(plan[1].stored.empty());
  EXPECT_EQ(CampaignReader::open(path_)->spec().trial_count(), 40U);
}

TEST_F(Store, AnotherSeedSpecOrBuildIsRefusedAndSaysWhatDiffers) {
  { ASSERT_TRUE(CampaignStore::open(path_, example_spec(), "build")); }
  const auto refusal = [&](const CampaignSpec& spec, const char* build) {
    const auto store = CampaignStore::open(path_, spec, build);
    return store ? std::string("accepted") : store.error().text();
  };
  EXPECT_NE(refusal(example_spec(2), "build").find("made with seed 1, this run has 2"), std::string::npos);
  EXPECT_EQ(refusal(example_spec(1, 10, 0.5), "build")
                .find("spec.toml:3: amplitude: is 0.5, the database was made with 0.25"),
            0U);
  EXPECT_NE(refusal(example_spec(), "another").find("build"), std::string::npos);
  EXPECT_EQ(refusal(example_spec(), "build"), "accepted");
}

TEST_F(Store, AFileThatIsNoDatabaseIsRefusedAndLeftAsItIs) {
  const std::string notes(5000, 'n');
  std::ofstream(path_) << notes;
  EXPECT_FALSE(CampaignStore::open(path_, example_spec(), "build"));
  EXPECT_FALSE(CampaignReader::open(path_));
  std::ifstream in(path_);
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(in), {}), notes);
}

TEST_F(Store, ADatabaseOfSomethingElseIsRefused) {
  {
    SQLite::Database other(path_, SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
    other.exec("CREATE TABLE trial (x)");
  }
  EXPECT_FALSE(CampaignStore::open(path_, example_spec(), "build"));
}

TEST_F(Store, ADamagedDatabaseIsSaidToBeDamagedAndWhere) {
  {
    auto store = CampaignStore::open(path_, example_spec(), "build");
    store->commit(std::vector{request({example_row(0, 0, 1.0)})});
  }
  {
    // Behind the header of the first page (100 bytes) stands the root of the schema.
    std::fstream file(path_, std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(100);
    file << std::string(400, '\xee');
  }
  const auto written = CampaignStore::open(path_, example_spec(), "build");
  const auto read = CampaignReader::open(path_);
  ASSERT_FALSE(written);
  ASSERT_FALSE(read);
  EXPECT_EQ(written.error().text().find(path_ + ": is damaged"), 0U) << written.error().text();
  EXPECT_EQ(read.error().text().find(path_ + ": is damaged"), 0U) << read.error().text();
}

TEST_F(Store, ResumingTakesOverTheFiguresToCompareWithAndKeepsTheRest) {
  const auto with_published = [](std::optional<double> figure, std::int64_t repetitions) {
    Tree tree = example_tree(1, repetitions);
    if (figure) {
      Tree published{Tree::Table{}, "published.toml", 1};
      published.set("value", Tree{*figure, "published.toml", 2});
      tree.set("published", published);
    }
    return *decode_campaign(tree);
  };
  const auto stored_text = [&] { return canonical_text(CampaignReader::open(path_)->spec().tree); };
  for (const std::optional<double> figure :
       {std::optional(90.0), std::optional(95.5), std::optional<double>()}) {
    const CampaignSpec spec = with_published(figure, 10);
    { ASSERT_TRUE(CampaignStore::open(path_, spec, "build")); }
    EXPECT_EQ(stored_text(), canonical_text(spec.tree));
    SQLite::Database db(path_);
    EXPECT_EQ(db.execAndGet("SELECT spec_canonical FROM campaign").getString(), canonical_text(spec.tree));
  }
}

TEST_F(Store, ASecondWriterIsToldSoWhateverSpecItHas) {
  const auto first = CampaignStore::open(path_, example_spec(), "build");
  ASSERT_TRUE(first);
  const auto second = CampaignStore::open(path_, example_spec(2), "build");
  ASSERT_FALSE(second);
  EXPECT_NE(second.error().text().find("another coordinator"), std::string::npos) << second.error().text();
}

TEST_F(Store, APlaceThatCannotHoldADatabaseIsAnError) {
  std::ofstream((folder_ / "notes")) << "notes";
  for (const std::string& path : {folder_.string(), (folder_ / "notes" / "c.db").string(),
                                  (folder_ / std::string(300, 'n')).string()}) {
    const auto store = CampaignStore::open(path, example_spec(), "build");
    ASSERT_FALSE(store);
    EXPECT_EQ(store.error().file, path);
    const auto reader = CampaignReader::open(path);
    ASSERT_FALSE(reader);
    EXPECT_EQ(reader.error().file, path);
  }
}

TEST_F(Store, AFileWithoutTablesIsAsGoodAsNew) {
  {
    SQLite::Database blank(path_, SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
    blank.exec("PRAGMA journal_mode = WAL");  // what a process leaves that dies right after opening
  }
  EXPECT_TRUE(CampaignStore::open(path_, example_spec(), "build"));
}

TEST_F(Store, LeavesASingleFileWhenClosed) {
  { ASSERT_TRUE(CampaignStore::open(path_, example_spec(), "build")); }
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_), {}), 1);
}

TEST_F(Store, ASecondWriterIsRefused) {
  const auto first = CampaignStore::open(path_, example_spec(), "build");
  ASSERT_TRUE(first);
  const auto second = CampaignStore::open(path_, example_spec(), "build");
  ASSERT_FALSE(second);
  EXPECT_NE(second.error().text().find("another coordinator"), std::string::npos);
}

TEST(SpecDifference, IsNeverInThePublishedFigures) {
  Tree now = example_tree(1, 10), then = now;
  now.set("published", Tree{1.0, "spec.toml", 2});
  EXPECT_FALSE(first_difference(now, then));
  EXPECT_FALSE(first_difference(then, now));
  then.set("published", Tree{2.0, "spec.toml", 2});
  EXPECT_FALSE(first_difference(now, then));
}

TEST(SpecDifference, NamesNewAndMissingKeysAndIgnoresRepetitions) {
  const Tree base = example_tree(1, 10);
  EXPECT_FALSE(first_difference(base, example_tree(1, 99)));
  Tree more = base;
  more.set("gain", Tree{0.1, "spec.toml", 12});
  EXPECT_EQ(first_difference(more, base)->text(),
            "spec.toml:12: gain: is new, the database was made without it");
  EXPECT_EQ(first_difference(base, more)->text(),
            "spec.toml:1: gain: is missing, the database was made with 0.1");
}

}  // namespace
}  // namespace fatmc
