// The database of one campaign: its only writer, and readers.
//
// WAL with synchronous=FULL: a commit is one append and one fsync, so that an acknowledged row outlives kill
// -9 and a power cut, and readers (`fatmc status`, `fatmc query`) never wait for the writer nor it for them.
// A rollback journal would sync twice or three times a commit and lock readers out meanwhile. The price:
// FILE-wal and FILE-shm stand beside FILE while it is open, and the file must be on a local disk.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "campaigns/base/campaign_spec.h"
#include "campaigns/base/study.h"
#include "coordinator/state/campaign_state.h"
#include "coordinator/store/control_tables.h"
#include "coordinator/store/storage_trouble.h"
#include "coordinator/store/writer_lock.h"
#include "core/base/error.h"

namespace SQLite {
class Database;
}

namespace fatmc {

/// Which rows count as stored when a campaign is planned: all, or those with a result, so that trials that
/// were given up are tried again.
enum class StoredTrials { all, results };

/// Writes a campaign's rows. I/O errors throw SQLite::Exception.
class CampaignStore {
 public:
  /// Makes the folder where there is none and becomes the only writer; the database is not touched.
  static Result<WriterLock> lock(const std::string& path);
  /// Creates the file, or opens one of the same spec, seed and build: it is resumed, extended where the spec
  /// has more repetitions, and given the spec's published figures. An Error says what differs and what to do.
  static Result<CampaignStore> open(WriterLock held, const std::string& path, const CampaignSpec& spec,
                                    const std::string& build);
  /// Locks and opens.
  static Result<CampaignStore> open(const std::string& path, const CampaignSpec& spec,
                                    const std::string& build);

  /// Brings a file of an older schema up to date, whatever its spec and build; the schema that was found.
  static Result<int> migrate(const std::string& path);

  CampaignStore(CampaignStore&&) noexcept;
  ~CampaignStore();

  /// Cells of the spec with what is stored of them.
  [[nodiscard]] std::vector<PlanCell> plan(const CampaignSpec& spec,
                                           StoredTrials counted = StoredTrials::all);

  /// One transaction, on disk when it returns. A row whose trial is stored already is left out: `duplicate`
  /// when its content hash is the same, else `conflict`; but a result takes the place of a row that says
  /// that the trial was given up. Throws StorageTrouble.
  std::vector<StoreReport> commit(std::span<const StoreRequest> requests);
  /// Calls `work`, in which all commits are one transaction: it becomes durable when `work` returns true, and
  /// leaves no trace when it returns false or throws.
  void atomically(const std::function<bool()>& work);

  /// What commands beside the coordinator want, and what it tells them. Not beyond the store's life.
  [[nodiscard]] ControlTables control();

 private:
  struct Parts;
  explicit CampaignStore(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

/// A row with all that is stored of it.
struct StoredRow {
  ComputedRow computed;
  std::string host;
  std::uint32_t pid = 0, attempts = 0;
};

struct OutcomeCount {
  std::string cell, outcome;
  std::uint64_t trials = 0;
};

struct CellProgress {
  std::string cell;
  std::uint64_t repetitions = 0, stored = 0;
  std::optional<double> mean_trial_s;  ///< none without a trial
};

/// Of the last minute of work.
struct Throughput {
  std::uint64_t trials = 0;
  double trials_per_s = 0.0;
  std::string until;  ///< UTC
};

struct RowSelection {
  std::uint64_t first = 0, last = std::uint64_t{1} << 40;
  bool arrays = true;
};

/// Reads a campaign's rows, also while another process writes them.
class CampaignReader {
 public:
  /// An Error, too, for a file of an older schema: CampaignStore::migrate() is the remedy.
  static Result<CampaignReader> open(const std::string& path);

  CampaignReader(CampaignReader&&) noexcept;
  ~CampaignReader();

  /// As stored, with the numbers of repetitions that the database plans.
  [[nodiscard]] const CampaignSpec& spec() const;
  [[nodiscard]] std::string build() const;
  [[nodiscard]] std::uint64_t stored() const;
  [[nodiscard]] std::vector<OutcomeCount> outcomes() const;
  /// In the order of the spec.
  [[nodiscard]] std::vector<CellProgress> cells() const;
  /// Over the trials that ended in the last 60 s before the last one, so that pauses between runs do not
  /// count; none when they are fewer than two.
  [[nodiscard]] std::optional<Throughput> throughput() const;
  /// Rows of a cell in the order of repetitions: all of them, or those of [first, last), with or without
  /// arrays.
  void visit(std::uint32_t cell, const std::function<void(const TrialRow&)>& visitor,
             RowSelection rows = {}) const;
  /// The same with provenance and the stored content hash, which is not compared with the row.
  void visit_stored(std::uint32_t cell, const std::function<void(StoredRow&)>& visitor,
                    RowSelection rows = {}) const;
  /// One row; none where it is not stored.
  [[nodiscard]] std::optional<StoredRow> trial(TrialKey key) const;
  [[nodiscard]] ControlTables control() const;
  /// For SummaryStudy; the reader must outlive it.
  [[nodiscard]] RowSource rows() const;
  /// SHA-256 over all results in the order of their keys: the same whoever computed them, and when.
  [[nodiscard]] std::string digest() const;
  [[nodiscard]] SQLite::Database& database() const;

 private:
  struct Parts;
  explicit CampaignReader(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

}  // namespace fatmc
