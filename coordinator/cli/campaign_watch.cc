#include "coordinator/cli/campaign_watch.h"

#include <SQLiteCpp/Exception.h>
#include <spdlog/spdlog.h>

#include <cmath>
#include <cstdio>

#include "core/base/check.h"
#include "core/base/text.h"

namespace fatmc::cli {
namespace {

constexpr std::chrono::milliseconds kLongLease{1000};  // most trials are over before
constexpr std::chrono::milliseconds kReportEvery{1000};

MonotonicTime now() { return std::chrono::steady_clock::now().time_since_epoch(); }

// Before the server runs there is no worker to tell anything.
class NoOutbox final : public Outbox {
 public:
  void send(const WorkerId&, const Message&) override {}
  void note(const std::string&) override {}
  void store(StoreRequest) override { FATMC_CHECK(false, "no worker, no rows"); }
};

}  // namespace

CampaignWatch::CampaignWatch(const CampaignSpec& spec, const std::string& database, bool is_shard,
                             CampaignState& state, CampaignStore& store)
    : spec_(spec), is_shard_(is_shard), state_(state), control_(store.control()) {
  if (spec.precision && !is_shard) monitor_.emplace(*spec.precision, spec.cells.size());
  control_.clear_stops();  // the rule may be another one now: it is evaluated from the first trial on
  control_.set_in_flight({});
  read_stored(database);
  NoOutbox nobody;
  end_precise_cells(
      [&](std::uint32_t cell, std::uint64_t n) { state_.set_repetitions(cell, n, now(), nobody); });
  wanted_ = control_.read();
  static_cast<void>(control_.changed());  // own writes and what is read already are no news
  if (wanted_.paused) state_.pause();
}

void CampaignWatch::read_stored(const std::string& database) {
  const Result<CampaignReader> reader = CampaignReader::open(database);
  FATMC_CHECK(reader.has_value(), "the database that was just opened");
  for (const OutcomeCount& count : reader->outcomes()) outcomes_[count.outcome] += count.trials;
  if (!monitor_) return;
  for (std::uint32_t cell = 0; cell < spec_.cells.size(); ++cell) {
    reader->visit(cell, [&](const TrialRow& row) { monitor_->add(row); },
                  {.first = 0, .last = spec_.cells[cell].repetitions, .arrays = false});
  }
}

void CampaignWatch::on_committed(const StoreRequest& request, const StoreReport& report,
                                 CampaignServer& server) {
  for (std::size_t i = 0; i < report.rows.size(); ++i) {
    if (report.rows[i].second != StoreOutcome::stored) continue;
    const TrialRow& row = request.rows[i].row;
    ++outcomes_[row.outcome];
    if (monitor_) monitor_->add(row);
  }
  end_precise_cells([&](std::uint32_t cell, std::uint64_t n) { server.set_repetitions(cell, n); });
}

void CampaignWatch::end_precise_cells(
    const std::function<void(std::uint32_t, std::uint64_t)>& set_repetitions) {
  if (!monitor_) return;
  if (monitor_->failure() != said_failure_) {
    said_failure_ = monitor_->failure();
    std::fprintf(stderr, "fatmc: %s\n", said_failure_.c_str());
  }
  while (!monitor_->reached().empty()) {
    const PrecisionReached reached = monitor_->reached().front();
    const PrecisionRule& rule = monitor_->rule();
    try {
      control_.stop({reached.cell, reached.at.trials, rule.metric, rule.sequence.level, reached.at.mean,
                     reached.at.interval.low, reached.at.interval.high});
    } catch (const SQLite::Exception& e) {
      spdlog::warn("a cell that is precise enough cannot be ended yet: {}", e.what());
      return;
    }
    monitor_->acknowledge();
    spdlog::info("cell {} is precise enough after {} trials", spec_.cells[reached.cell].name,
                 reached.at.trials);
    set_repetitions(reached.cell, reached.at.trials);
  }
}

void CampaignWatch::on_tick(CampaignServer& server) {
  try {
    if (control_.changed()) obey(server);
    end_precise_cells([&](std::uint32_t cell, std::uint64_t n) { server.set_repetitions(cell, n); });
    if (now() - last_report_ >= kReportEvery) report_leases();
  } catch (const SQLite::Exception& e) {
    spdlog::warn("control tables: {}", e.what());  // nothing of the results; the next tick tries again
  }
}

void CampaignWatch::obey(CampaignServer& server) {
  const ControlState wanted = control_.read();
  for (std::uint32_t cell = 0; cell < wanted.repetitions.size() && cell < spec_.cells.size(); ++cell) {
    if (is_shard_ || wanted.repetitions[cell] == wanted_.repetitions[cell]) continue;
    // More trials alone: what is stored is never thrown away on a wish.
    if (wanted.repetitions[cell] <= state_.repetitions(cell)) continue;
    spdlog::info("cell {} extended to {} trials", spec_.cells[cell].name, wanted.repetitions[cell]);
    server.set_repetitions(cell, wanted.repetitions[cell]);
  }
  if (wanted.paused != state_.paused()) {
    spdlog::info(wanted.paused ? "paused" : "resumed");
    server.set_paused(wanted.paused);
  }
  wanted_ = wanted;
}

void CampaignWatch::report_leases() {
  last_report_ = now();
  std::vector<TrialsInFlight> trials;
  for (const LeaseView& lease : state_.leases(now(), kLongLease)) {
    trials.push_back({lease.cell, lease.first, lease.last, lease.missing, lease.attempts, lease.host,
                      lease.pid, std::chrono::duration<double>(now() - lease.since).count()});
  }
  if (trials.empty() && !leases_reported_) return;
  control_.set_in_flight(trials);
  leases_reported_ = !trials.empty();
}

void CampaignWatch::on_end(bool failed) {
  if (failed || !leases_reported_) return;
  try {
    control_.set_in_flight({});
  } catch (const SQLite::Exception& e) {
    spdlog::warn("control tables: {}", e.what());
  }
}

Progress CampaignWatch::progress() const {
  Progress out;
  out.done = state_.stored();
  out.total = state_.planned();
  for (const auto& [outcome, trials] : outcomes_) out.failed += outcome == "ok" ? 0 : trials;
  out.paused = state_.paused();
  out.precision = precision_text();
  return out;
}

// The cell with the widest interval says how precise the answer is.
std::string CampaignWatch::precision_text() const {
  if (!monitor_) return "";
  std::optional<std::uint32_t> widest;
  double half = -1.0;
  for (std::uint32_t cell = 0; cell < spec_.cells.size(); ++cell) {
    const CellPrecision now = monitor_->now(cell);
    const double own = 0.5 * (now.interval.high - now.interval.low);
    if (now.values >= 2 && std::isfinite(own) && own > half) {
      half = own;
      widest = cell;
    }
  }
  if (!widest) return "";
  const CellPrecision now = monitor_->now(*widest);
  std::string text = monitor_->rule().metric + " " + significant(now.mean, 4) + " in [" +
                     significant(now.interval.low, 4) + ", " + significant(now.interval.high, 4) + "]";
  if (monitor_->rule().half_width)
    text += ", half-width wanted " + significant(*monitor_->rule().half_width, 3);
  if (spec_.cells.size() > 1) text += " (" + spec_.cells[*widest].name + ")";
  return text;
}

}  // namespace fatmc::cli
