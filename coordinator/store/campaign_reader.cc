#include <SQLiteCpp/SQLiteCpp.h>
#include <SQLiteCpp/Savepoint.h>
#include <sqlite3.h>

#include <cstring>
#include <filesystem>
#include <map>

#include "coordinator/store/campaign_store.h"
#include "coordinator/store/database_error.h"
#include "coordinator/store/schema.h"
#include "coordinator/store/stored_campaign.h"

namespace fatmc {
namespace {

// Advances a statement ordered by trial through the rows of one trial.
template <typename Use>
void consume(SQLite::Statement& statement, bool& more, std::int64_t trial, Use use) {
  while (more && statement.getColumn(0).getInt64() < trial) more = statement.executeStep();
  while (more && statement.getColumn(0).getInt64() == trial) {
    use();
    more = statement.executeStep();
  }
}

std::map<std::int64_t, std::string> read_names(SQLite::Database& db) {
  std::map<std::int64_t, std::string> names;
  SQLite::Statement all(db, "SELECT id, text FROM name");
  while (all.executeStep()) names.emplace(all.getColumn(0).getInt64(), all.getColumn(1).getString());
  return names;
}

double read_real(const SQLite::Column& column) {
  if (!column.isBlob()) return column.getDouble();
  double value = 0.0;  // a NaN, see CampaignStore
  if (column.getBytes() == sizeof value) std::memcpy(&value, column.getBlob(), sizeof value);
  return value;
}

std::vector<double> read_reals(const SQLite::Column& column) {
  std::vector<double> values(static_cast<std::size_t>(column.getBytes()) / sizeof(double));
  if (!values.empty()) std::memcpy(values.data(), column.getBlob(), values.size() * sizeof(double));
  return values;
}

// All but key, metrics and arrays.
StoredRow read_trial(SQLite::Statement& trial) {
  StoredRow out;
  out.computed.row.outcome = trial.getColumn(2).getString();
  out.computed.row.detail = trial.getColumn(3).getString();
  const SQLite::Column hash = trial.getColumn(4);
  if (hash.getBytes() == static_cast<int>(out.computed.hash.size()))
    std::memcpy(out.computed.hash.data(), hash.getBlob(), out.computed.hash.size());
  out.host = trial.getColumn(5).getString();
  out.pid = trial.getColumn(6).getUInt();
  out.attempts = trial.getColumn(7).getUInt();
  out.computed.started_us = static_cast<std::uint64_t>(trial.getColumn(8).getInt64());
  out.computed.duration_ns = static_cast<std::uint64_t>(trial.getColumn(9).getInt64());
  return out;
}

}  // namespace

struct CampaignReader::Parts {
  std::unique_ptr<SQLite::Database> db;
  StoredCampaign campaign;
};

CampaignReader::CampaignReader(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
CampaignReader::CampaignReader(CampaignReader&&) noexcept = default;
CampaignReader::~CampaignReader() = default;

Result<CampaignReader> CampaignReader::open(const std::string& path) {
  std::error_code error;
  const auto kind = std::filesystem::status(path, error).type();
  if (kind == std::filesystem::file_type::none) {
    return fail(
        Error{path, 0, "", "cannot be read (" + error.message() + "), name a database that you may read"});
  }
  if (kind != std::filesystem::file_type::regular) {
    return fail(Error{path, 0, "", "no such database, name one that `fatmc run` made"});
  }
  try {
    auto db = std::make_unique<SQLite::Database>(path, SQLite::OPEN_READONLY, 5000);
    Result<StoredCampaign> campaign = read_campaign(*db, path);
    if (!campaign) return fail(campaign.error());
    if (campaign->schema < kSchemaVersion) {
      return fail(Error{path, 0, "",
                        "has schema " + std::to_string(campaign->schema) + ", older than this program's " +
                            std::to_string(kSchemaVersion) + "; bring it up to date by: fatmc migrate " +
                            path});
    }
    return CampaignReader(std::make_unique<Parts>(Parts{std::move(db), std::move(*campaign)}));
  } catch (const SQLite::Exception& e) {
    if (!is_fault_of_file(e)) throw;
    return fail(database_error(e, path));
  }
}

const CampaignSpec& CampaignReader::spec() const { return parts_->campaign.spec; }
std::string CampaignReader::build() const { return parts_->campaign.build; }
SQLite::Database& CampaignReader::database() const { return *parts_->db; }

std::uint64_t CampaignReader::stored() const {
  return static_cast<std::uint64_t>(parts_->db->execAndGet("SELECT count(*) FROM trial").getInt64());
}

std::vector<OutcomeCount> CampaignReader::outcomes() const {
  std::vector<OutcomeCount> out;
  SQLite::Statement rows(*parts_->db, "SELECT cell, outcome, trials FROM outcomes");
  while (rows.executeStep()) {
    out.push_back({rows.getColumn(0).getString(), rows.getColumn(1).getString(),
                   static_cast<std::uint64_t>(rows.getColumn(2).getInt64())});
  }
  return out;
}

std::vector<CellProgress> CampaignReader::cells() const {
  std::vector<CellProgress> out;
  SQLite::Statement rows(*parts_->db, "SELECT cell, repetitions, stored, mean_trial_s FROM cells");
  while (rows.executeStep()) {
    CellProgress cell;
    cell.cell = rows.getColumn(0).getString();
    cell.repetitions = static_cast<std::uint64_t>(rows.getColumn(1).getInt64());
    cell.stored = static_cast<std::uint64_t>(rows.getColumn(2).getInt64());
    if (!rows.getColumn(3).isNull()) cell.mean_trial_s = rows.getColumn(3).getDouble();
    out.push_back(std::move(cell));
  }
  return out;
}

std::optional<Throughput> CampaignReader::throughput() const {
  SQLite::Statement last(
      *parts_->db,
      "WITH ended AS (SELECT started_us / 1e6 + duration_ns / 1e9 AS t FROM trial), "
      "top AS (SELECT max(t) AS t FROM ended) "
      "SELECT count(*), max(ended.t) - min(ended.t), strftime('%Y-%m-%dT%H:%M:%SZ', top.t, 'unixepoch') "
      "FROM ended, top WHERE ended.t > top.t - 60");
  if (!last.executeStep() || last.getColumn(0).getInt64() < 2) return std::nullopt;
  const double span = last.getColumn(1).getDouble();
  if (!(span > 0.0)) return std::nullopt;
  const auto trials = static_cast<std::uint64_t>(last.getColumn(0).getInt64());
  return Throughput{trials, static_cast<double>(trials - 1) / span, last.getColumn(2).getString()};
}

void CampaignReader::visit(std::uint32_t cell, const std::function<void(const TrialRow&)>& visitor,
                           RowSelection rows) const {
  visit_stored(cell, [&](StoredRow& stored) { visitor(stored.computed.row); }, rows);
}

void CampaignReader::visit_stored(std::uint32_t cell, const std::function<void(StoredRow&)>& visitor,
                                  RowSelection rows) const {
  SQLite::Database& db = *parts_->db;
  SQLite::Savepoint snapshot(db, "visit");  // several statements, one state of the database; visits may nest
  const auto names = read_names(db);
  const std::string range = " BETWEEN " + std::to_string(trial_id({cell, rows.first})) + " AND " +
                            std::to_string(trial_id({cell, 0}) + static_cast<std::int64_t>(rows.last) - 1) +
                            " ORDER BY ";
  SQLite::Statement trials(db,
                           "SELECT id, repetition, outcome, detail, content_hash, host, pid, attempts, "
                           "started_us, duration_ns FROM trial WHERE id" +
                               range + "id");
  SQLite::Statement metrics(db,
                            "SELECT trial, name, value FROM metric WHERE trial" + range + "trial, position");
  SQLite::Statement arrays(db, "SELECT trial, name, data FROM array WHERE trial" + range + "trial, position");
  bool more_metrics = metrics.executeStep();
  bool more_arrays = rows.arrays && arrays.executeStep();
  while (trials.executeStep()) {
    StoredRow stored = read_trial(trials);
    TrialRow& row = stored.computed.row;
    row.key = {cell, static_cast<std::uint64_t>(trials.getColumn(1).getInt64())};
    const std::int64_t id = trials.getColumn(0).getInt64();
    consume(metrics, more_metrics, id, [&] {
      row.metrics.emplace_back(names.at(metrics.getColumn(1).getInt64()), read_real(metrics.getColumn(2)));
    });
    consume(arrays, more_arrays, id, [&] {
      row.arrays.emplace_back(names.at(arrays.getColumn(1).getInt64()), read_reals(arrays.getColumn(2)));
    });
    visitor(stored);
  }
  for (SQLite::Statement* statement : {&trials, &metrics, &arrays}) statement->reset();
  snapshot.release();
}

std::optional<StoredRow> CampaignReader::trial(TrialKey key) const {
  std::optional<StoredRow> out;
  visit_stored(
      key.cell, [&](StoredRow& row) { out = std::move(row); },
      {.first = key.repetition, .last = key.repetition + 1});
  return out;
}

ControlTables CampaignReader::control() const { return ControlTables(*parts_->db); }

RowSource CampaignReader::rows() const {
  return [this](std::uint32_t cell, const std::function<void(const TrialRow&)>& visitor) {
    visit(cell, visitor);
  };
}

std::string CampaignReader::digest() const {
  Digest digest;
  const auto& cells = spec().cells;
  for (std::uint32_t cell = 0; cell < cells.size(); ++cell) {
    visit(cell, [&](const TrialRow& row) { digest.add(cells[cell].name, row); });
  }
  return digest.text();
}

}  // namespace fatmc
