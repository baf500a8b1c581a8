#include "coordinator/store/shard_merge.h"

#include <algorithm>
#include <filesystem>
#include <optional>

#include "coordinator/store/campaign_store.h"
#include "coordinator/store/database_file.h"

namespace fatmc {
namespace {

constexpr std::size_t kRowsAtATime = 100;

std::string trial_text(const CampaignSpec& spec, TrialKey key) {
  return "trial " + std::to_string(key.repetition) + " of cell \"" + spec.cells.at(key.cell).name + "\"";
}

// What all shards plan together; an Error where they are not of one campaign.
Result<CampaignSpec> common_spec(const std::vector<std::string>& shards,
                                 const std::vector<CampaignReader>& readers) {
  CampaignSpec spec = readers.front().spec();
  const StoredCampaign first{spec, spec.identity(), readers.front().build(), 0};
  for (std::size_t i = 1; i < readers.size(); ++i) {
    const Status same = check_same(shards.front(), first, readers[i].spec(), readers[i].build());
    if (!same) {
      return fail(Error{shards[i], 0, "",
                        "is of another campaign than " + shards.front() + " (" + same.error().text() +
                            "), name shards of one campaign"});
    }
    for (std::size_t cell = 0; cell < spec.cells.size(); ++cell) {
      spec.cells[cell].repetitions =
          std::max(spec.cells[cell].repetitions, readers[i].spec().cells.at(cell).repetitions);
    }
  }
  return spec;
}

// Copies the rows of one shard into a store.
class ShardCopy {
 public:
  ShardCopy(CampaignStore& store, const CampaignReader& shard, std::string path, MergeReport& report)
      : store_(store), shard_(shard), path_(std::move(path)), report_(report) {}

  Status run() {
    for (std::uint32_t cell = 0; cell < shard_.spec().cells.size() && !error_; ++cell) {
      shard_.visit_stored(cell, [&](StoredRow& row) {
        if (!error_) take(row);
      });
      if (!error_) flush();
    }
    if (error_) return fail(*error_);
    return {};
  }

 private:
  void take(StoredRow& row) {
    if (content_hash(row.computed.row) != row.computed.hash) {
      error_ =
          Error{path_, 0, "",
                trial_text(shard_.spec(), row.computed.row.key) +
                    " does not match its content hash: the file is damaged, restore a copy of it; nothing "
                    "was merged"};
      return;
    }
    requests_.push_back({"", 0, std::move(row.host), row.pid, {std::move(row.computed)}, {row.attempts}});
    if (requests_.size() >= kRowsAtATime) flush();
  }

  void flush() {
    for (const StoreReport& stored : store_.commit(requests_)) {
      const auto& [key, outcome] = stored.rows.front();
      report_.added += outcome == StoreOutcome::stored ? 1 : 0;
      report_.duplicates += outcome == StoreOutcome::duplicate ? 1 : 0;
      if (outcome == StoreOutcome::conflict && !error_) {
        error_ = Error{path_, 0, "",
                       "ALARM: " + trial_text(shard_.spec(), key) +
                           " has another result than in what was merged before: trials of this build are not "
                           "reproducible; nothing was merged, fatmc replay tells which of the two is right"};
      }
    }
    requests_.clear();
  }

  CampaignStore& store_;
  const CampaignReader& shard_;
  std::string path_;
  MergeReport& report_;
  std::vector<StoreRequest> requests_;
  std::optional<Error> error_;
};

Result<MergeReport> copy_all(const std::string& output, const std::vector<std::string>& shards,
                             const std::vector<CampaignReader>& readers, const CampaignSpec& spec,
                             const std::function<void(std::size_t)>& progress) {
  Result<CampaignStore> store = CampaignStore::open(output, spec, readers.front().build());
  if (!store) return fail(store.error());
  MergeReport report;
  Status status;
  store->atomically([&] {
    for (std::size_t i = 0; i < readers.size() && status; ++i) {
      if (progress) progress(i);
      status = ShardCopy(*store, readers[i], shards[i], report).run();
    }
    return status.has_value();
  });
  if (!status) return fail(status.error());
  return report;
}

}  // namespace

Result<MergeReport> merge_shards(const std::string& output, const std::vector<std::string>& shards,
                                 const std::function<void(std::size_t)>& progress) {
  std::vector<CampaignReader> readers;
  for (const std::string& shard : shards) {
    std::error_code error;
    if (std::filesystem::equivalent(shard, output, error))
      return fail(Error{shard, 0, "", "is the output itself, name another output"});
    Result<CampaignReader> reader = CampaignReader::open(shard);
    if (!reader) return fail(reader.error());
    readers.push_back(std::move(*reader));
  }
  Result<CampaignSpec> spec = common_spec(shards, readers);
  if (!spec) return fail(spec.error());
  const bool is_new = !std::filesystem::exists(output);
  const auto discard = [&] {
    std::error_code ignored;
    if (is_new) std::filesystem::remove(output, ignored);
  };
  try {
    Result<MergeReport> report = copy_all(output, shards, readers, *spec, progress);
    if (!report) {
      discard();
      return report;
    }
    const Result<CampaignReader> merged = CampaignReader::open(output);
    if (!merged) return fail(merged.error());
    report->stored = merged->stored();
    report->planned = merged->spec().trial_count();
    return report;
  } catch (...) {
    discard();
    throw;
  }
}

}  // namespace fatmc
