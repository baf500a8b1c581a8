// Databases of older programs.
#include "coordinator/store/migration.h"

#include <SQLiteCpp/SQLiteCpp.h>

#include "coordinator/store/schema.h"
#include "proto/wire.h"
#include "tests/unit/store/example_rows.h"
#include "tests/unit/store/schema_1.h"

namespace fatmc {
namespace {

class Migration : public StoreFolder {
 protected:
  // By the statements of the program of that time.
  void write_version_1(const CampaignSpec& spec, const std::vector<ComputedRow>& rows) const {
    SQLite::Database db(path_, SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
    SQLite::Transaction transaction(db);
    db.exec(kSchema1Sql);
    db.exec("PRAGMA application_id = 1179929923");
    db.exec("PRAGMA user_version = 1");
    SQLite::Statement campaign(
        db, "INSERT INTO campaign VALUES (1, ?, ?, ?, ?, ?, ?, ?, '2026-01-01T00:00:00Z')");
    const std::string frame = encode(Welcome{spec.identity(), spec.tree, 500});
    campaign.bind(1, spec.name);
    campaign.bind(2, spec.study);
    campaign.bind(3, static_cast<std::int64_t>(spec.seed));
    campaign.bind(4, spec.identity());
    campaign.bind(5, "build");
    campaign.bind(6, canonical_text(spec.tree));
    campaign.bind(7, frame.data(), static_cast<int>(frame.size()));
    campaign.exec();
    db.exec("INSERT INTO cell VALUES (0, 'a', 10)");
    db.exec("INSERT INTO cell VALUES (1, 'b', 10)");
    for (const ComputedRow& row : rows) write_row(db, row);
    transaction.commit();
  }

  [[nodiscard]] std::vector<std::string> schema_of(const std::string& path) const {
    SQLite::Database db(path);
    SQLite::Statement all(db, "SELECT sql FROM sqlite_master WHERE sql IS NOT NULL ORDER BY type, name");
    std::vector<std::string> out;
    while (all.executeStep()) out.push_back(all.getColumn(0).getString());
    return out;
  }

 private:
  static void write_row(SQLite::Database& db, const ComputedRow& row) {
    const std::int64_t id = trial_id(row.row.key);
    SQLite::Statement trial(db, "INSERT INTO trial VALUES (?, ?, ?, 'ok', '', ?, 'host', 7, 1, 5, 1000)");
    trial.bind(1, id);
    trial.bind(2, static_cast<std::int64_t>(row.row.key.cell));
    trial.bind(3, static_cast<std::int64_t>(row.row.key.repetition));
    trial.bind(4, row.hash.data(), static_cast<int>(row.hash.size()));
    trial.exec();
    std::int64_t position = 0;
    for (const auto& [name, value] : row.row.metrics) {
      SQLite::Statement metric(db, "INSERT INTO metric VALUES (?, ?, ?, ?)");
      metric.bind(1, id);
      metric.bind(2, position++);
      metric.bind(3, name_id(db, name));
      if (std::isnan(value)) {
        metric.bind(4, &value, sizeof value);
      } else {
        metric.bind(4, value);
      }
      metric.exec();
    }
    position = 0;
    for (const auto& [name, values] : row.row.arrays) {
      SQLite::Statement array(db, "INSERT INTO array VALUES (?, ?, ?, ?)");
      array.bind(1, id);
      array.bind(2, position++);
      array.bind(3, name_id(db, name));
      array.bind(4, values.empty() ? static_cast<const void*>("") : values.data(),
                 static_cast<int>(values.size() * sizeof(double)));
      array.exec();
    }
  }
  static std::int64_t name_id(SQLite::Database& db, const std::string& name) {
    SQLite::Statement insert(db, "INSERT OR IGNORE INTO name (text) VALUES (?)");
    insert.bind(1, name);
    insert.exec();
    SQLite::Statement find(db, "SELECT id FROM name WHERE text = ?");
    find.bind(1, name);
    find.executeStep();
    return find.getColumn(0).getInt64();
  }
};

const std::vector<ComputedRow>& rows() {
  static const std::vector<ComputedRow> all = {example_row(0, 0, 0.1), example_row(0, 7, std::nan("9")),
                                               example_row(1, 3, 1e-310)};
  return all;
}

TEST_F(Migration, ResumingAFileOfVersion1KeepsEveryRowBitForBit) {
  write_version_1(example_spec(), rows());
  auto store = CampaignStore::open(path_, example_spec(1, 20), "build");
  ASSERT_TRUE(store) << store.error().text();
  EXPECT_EQ(store->plan(example_spec(1, 20))[0].stored.size(), 2U);
  const auto reader = CampaignReader::open(path_);
  ASSERT_TRUE(reader) << reader.error().text();
  std::vector<Sha256> hashes;
  for (std::uint32_t cell = 0; cell < 2; ++cell)
    reader->visit(cell, [&](const TrialRow& row) { hashes.push_back(content_hash(row)); });
  EXPECT_EQ(hashes, (std::vector<Sha256>{rows()[0].hash, rows()[1].hash, rows()[2].hash}));
}

TEST_F(Migration, LeavesTheSchemaOfANewFile) {
  write_version_1(example_spec(), rows());
  ASSERT_EQ(CampaignStore::migrate(path_).value(), 1);
  { ASSERT_TRUE(CampaignStore::open(file("new.db"), example_spec(), "build")); }
  EXPECT_EQ(schema_of(path_), schema_of(file("new.db")));
  EXPECT_EQ(CampaignStore::migrate(path_).value(), kSchemaVersion) << "nothing is left to do";
}

TEST_F(Migration, NeedsNeitherTheSpecNorTheBuildOfTheFile) {
  write_version_1(example_spec(5), rows());
  const auto before = CampaignReader::open(path_);
  ASSERT_FALSE(before);
  EXPECT_NE(before.error().text().find("fatmc migrate " + path_), std::string::npos) << before.error().text();
  ASSERT_TRUE(CampaignStore::migrate(path_));
  const auto reader = CampaignReader::open(path_);
  ASSERT_TRUE(reader) << reader.error().text();
  EXPECT_EQ(reader->spec().seed, 5U);
  EXPECT_EQ(reader->stored(), 3U);
}

TEST_F(Migration, AFileThatIsRefusedIsNotMigrated) {
  write_version_1(example_spec(), rows());
  EXPECT_FALSE(CampaignStore::open(path_, example_spec(2), "build"));
  EXPECT_EQ(SQLite::Database(path_).execAndGet("PRAGMA user_version").getInt(), 1);
}

TEST_F(Migration, ANewerVersionIsRefusedInOneLine) {
  { ASSERT_TRUE(CampaignStore::open(path_, example_spec(), "build")); }
  SQLite::Database(path_, SQLite::OPEN_READWRITE).exec("PRAGMA user_version = 9");
  const std::string expected = path_ + ": has schema 9, this program knows schemas up to " +
                               std::to_string(kSchemaVersion) + "; use the program that made it";
  EXPECT_EQ(CampaignStore::open(path_, example_spec(), "build").error().text(), expected);
  EXPECT_EQ(CampaignReader::open(path_).error().text(), expected);
  EXPECT_EQ(CampaignStore::migrate(path_).error().text(), expected);
}

TEST_F(Migration, OfADamagedFileChangesNothing) {
  write_version_1(example_spec(), rows());
  {
    SQLite::Database db(path_, SQLite::OPEN_READWRITE);
    db.exec("UPDATE trial SET attempts = 'many' WHERE id = 7");  // what a STRICT table refuses
  }
  EXPECT_THROW((void)CampaignStore::migrate(path_), SQLite::Exception);
  SQLite::Database db(path_);
  EXPECT_EQ(db.execAndGet("PRAGMA user_version").getInt(), 1);
  EXPECT_EQ(db.execAndGet("SELECT count(*) FROM trial").getInt(), 3);
  EXPECT_EQ(db.execAndGet("SELECT count(*) FROM outcomes").getInt(), 2);
}

TEST_F(Migration, HistoryTellsWhatHappened) {
  write_version_1(example_spec(), rows());
  { ASSERT_TRUE(CampaignStore::open(path_, example_spec(), "build")); }
  SQLite::Database db(path_);
  EXPECT_EQ(db.execAndGet("SELECT group_concat(what || ' ' || detail, '; ') FROM history").getString(),
            "migrated from schema 1 to 2; resumed 20 trials planned");
}

}  // namespace
}  // namespace fatmc
