#include "coordinator/store/stored_campaign.h"

#include <SQLiteCpp/SQLiteCpp.h>

#include "coordinator/store/database_error.h"
#include "coordinator/store/migration.h"
#include "proto/wire.h"

namespace fatmc {
namespace {

Result<CampaignSpec> decode_spec(SQLite::Database& db, const SQLite::Column& blob, const std::string& path) {
  const Result<Message> frame = decode(
      std::string_view(static_cast<const char*>(blob.getBlob()), static_cast<std::size_t>(blob.getBytes())));
  if (!frame || !std::holds_alternative<Welcome>(*frame)) {
    return fail(Error{path, 0, "campaign.spec", "cannot be read, the file is damaged"});
  }
  Result<CampaignSpec> spec = decode_campaign(std::get<Welcome>(*frame).spec);
  if (!spec) return spec;
  SQLite::Statement cells(db, "SELECT name, repetitions FROM cell ORDER BY id");
  for (Cell& cell : spec->cells) {
    if (!cells.executeStep() || cells.getColumn(0).getString() != cell.name) {
      return fail(Error{path, 0, "cell", "does not match the spec, the file is damaged"});
    }
    cell.repetitions = static_cast<std::uint64_t>(cells.getColumn(1).getInt64());
  }
  return spec;
}

}  // namespace

Result<StoredCampaign> read_campaign(SQLite::Database& db, const std::string& path) {
  try {
    const Result<int> version = schema_version(db, path);
    if (!version) return fail(version.error());
    SQLite::Statement row(db, "SELECT spec, identity, build FROM campaign");
    if (!row.executeStep()) return fail(Error{path, 0, "campaign", "is empty, the file is damaged"});
    Result<CampaignSpec> spec = decode_spec(db, row.getColumn(0), path);
    if (!spec) return fail(spec.error());
    return StoredCampaign{std::move(*spec), row.getColumn(1).getString(), row.getColumn(2).getString(),
                          *version};
  } catch (const SQLite::Exception& e) {
    if (!is_fault_of_file(e)) throw;
    return fail(database_error(e, path));
  }
}

}  // namespace fatmc
