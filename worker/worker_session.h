// A worker's side of docs/protocol.md, without socket, thread or clock.
//
// Events come in as calls that carry the time, what is to be done goes out through a WorkerPort. Rows are
// kept until the coordinator acknowledges them, and sent again when it does not, when the connection breaks,
// when it comes back, or when another takes its place.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "worker/result_outbox.h"
#include "worker/trial_runner.h"

namespace fatmc {

class WorkerPort {
 public:
  virtual ~WorkerPort() = default;
  virtual void send(const std::string& frame) = 0;
  virtual void begin(const std::shared_ptr<LoadedCampaign>& campaign, const Lease& lease) = 0;
  /// Forget trials that have not begun.
  virtual void drop_queue() = 0;
  /// Why the worker does what it does, for the log.
  virtual void note(const std::string& /*what*/) {}
};

struct WorkerEnd {
  int code = 0;           ///< exit code of the program
  std::string why;        ///< for the log
  std::string complaint;  ///< for the user; empty when all is well
};

class WorkerSession {
 public:
  using Time = ResultOutbox::Time;

  /// `leave_after`: ends when nothing was heard for so long, and on any BYE; without, it tries for ever
  /// unless the campaign is finished.
  WorkerSession(Hello self, std::optional<std::chrono::milliseconds> leave_after, WorkerPort& port, Time now);

  void on_message(const Message& message, Time now);
  /// A connection stands, the first or a new one: whatever was on its way is sent again.
  void on_connected(Time now);
  void on_news(RunnerNews news, Time now);
  void on_tick(Time now);
  /// Told to stop: sends what is there, and BYE.
  void leave(Time now);

  /// When on_tick() is wanted at the latest.
  [[nodiscard]] std::chrono::milliseconds until_due(Time now) const;
  /// Nothing was heard for four heartbeats: the connection may be dead without knowing it.
  [[nodiscard]] bool is_deaf(Time now) const { return now - last_heard_ > 4 * heartbeat_; }
  [[nodiscard]] bool welcomed() const { return welcomed_; }
  [[nodiscard]] const std::optional<WorkerEnd>& end() const { return end_; }

 private:
  void send(const Message& message) { port_.send(encode(message)); }
  void say_hello(Time now);
  void handle_welcome(const Welcome& welcome, Time now);
  void handle_lease(const Lease& lease);
  void handle_ack(const Ack& ack);
  void handle_refused(const Refused& refused, Time now);
  void handle_bye(const Bye& bye, Time now);
  void send_results(bool all, Time now);
  void send_credit();
  void beat(Time now);

  const Hello self_;
  const std::optional<std::chrono::milliseconds> leave_after_;
  WorkerPort& port_;
  std::shared_ptr<LoadedCampaign> campaign_;
  bool welcomed_ = false;
  std::chrono::milliseconds heartbeat_{500};
  Time last_heard_, last_hello_{}, last_beat_{};
  std::uint64_t newest_lease_ = 0;
  std::map<std::uint64_t, std::uint64_t> leases_;  // -> rows not yet acknowledged
  ResultOutbox outbox_;
  Credit credit_;
  std::optional<Credit> told_;
  std::optional<WorkerEnd> end_;
};

}  // namespace fatmc
