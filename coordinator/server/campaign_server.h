// The coordinator's socket loop: one thread that owns the ROUTER socket and the database.
//
// Messages go to CampaignState, whose decisions it carries out. Rows are gathered and committed in one
// transaction as soon as there are 1,000, or the oldest has waited for 50 ms, or nothing more can come; only
// then are they acknowledged. Messages that are malformed or too large are counted and dropped.
//
// When the database cannot take rows (disk full, I/O error), dispatch pauses, rows that come are left with
// their workers, who send them again, and the commit is repeated until it succeeds.
#pragma once

#include <signal.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "coordinator/server/bound_socket.h"
#include "coordinator/server/group_commit.h"
#include "coordinator/server/peer_limits.h"
#include "coordinator/state/campaign_state.h"
#include "coordinator/store/campaign_store.h"
#include "core/base/error.h"

namespace fatmc {

struct ServerOptions {
  GroupCommitOptions commits;
  std::chrono::milliseconds tick{100};
  /// How long workers are waited for that do not answer the last BYE: enough for one that takes its connection
  /// for dead after 2 s and makes another.
  std::chrono::milliseconds farewell{3000};
  RateLimits rates;
};

/// What happens beside the socket. Each is called on the server's thread and may be empty.
struct ServerHooks {
  std::function<void()> on_tick;
  /// After each commit, for every request of it: what came and what became of it.
  std::function<void(const StoreRequest&, const StoreReport&)> on_committed;
  /// A child of this process has ended (SIGCHLD).
  std::function<void()> on_child;
  /// A reason to give up, or an empty string.
  std::function<std::string()> failure;
};

enum class ServerEnd { finished, interrupted, failed };

class CampaignServer : private Outbox {
 public:
  /// SIGINT, SIGTERM and SIGCHLD must be blocked (BlockedSignals) before.
  CampaignServer(BoundSocket socket, const ServerOptions& options, CampaignState& state,
                 CampaignStore& store);
  ~CampaignServer() override;

  /// Serves until all is stored, a signal comes, or a hook reports a failure; then says BYE to all workers. The
  /// BYE of a finished campaign is said until each has answered: one that missed it would wait for ever.
  /// Throws when the database fails for good (damaged, gone).
  ServerEnd run(const ServerHooks& hooks);
  /// CampaignState::set_repetitions, pause and resume, from inside a hook.
  void set_repetitions(std::uint32_t cell, std::uint64_t repetitions);
  void set_paused(bool paused);
  /// A process of this host has ended; `how` it died, empty when it left in peace.
  void on_process_ended(std::uint32_t pid, const std::string& how);
  /// Messages that could not be read.
  [[nodiscard]] std::uint64_t malformed() const { return malformed_; }
  /// Messages dropped unread, of peers that send too much.
  [[nodiscard]] std::uint64_t throttled() const { return limits_.dropped(); }
  [[nodiscard]] const BoundSocket& socket() const;

 private:
  struct Parts;
  void send(const WorkerId& worker, const Message& message) override;
  void store(StoreRequest request) override;
  void note(const std::string& what) override;
  void receive();
  void commit();
  std::vector<StoreReport> write(std::span<StoreRequest> batch);
  /// What came while the server waited for a message.
  struct Signals {
    bool interrupted = false, child = false;
  };
  Signals wait(std::chrono::milliseconds time);
  void tick(MonotonicTime last);
  void say_bye(bool finished);
  void see_off();
  [[nodiscard]] std::chrono::milliseconds wait_time() const;

  ServerOptions options_;
  CampaignState& state_;
  CampaignStore& store_;
  std::unique_ptr<Parts> parts_;
  const ServerHooks* hooks_ = nullptr;   // of run()
  std::vector<StoreRequest> committed_;  // by the last commit
  GroupCommit commits_;
  PeerLimits limits_;
  std::uint64_t malformed_ = 0;
};

/// Blocks SIGINT, SIGTERM and SIGCHLD, which the server reads from a descriptor, as long as it lives. To be
/// made before any thread exists.
class BlockedSignals {
 public:
  BlockedSignals();
  ~BlockedSignals();
  BlockedSignals(const BlockedSignals&) = delete;
  BlockedSignals& operator=(const BlockedSignals&) = delete;

 private:
  sigset_t before_;
};

}  // namespace fatmc
