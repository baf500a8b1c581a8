#include "worker/worker.h"

#include <signal.h>
#include <spdlog/cfg/env.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>
#include <sys/eventfd.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <random>
#include <zmq.hpp>

#include "core/base/build_hash.h"
#include "proto/host_name.h"
#include "proto/wire.h"
#include "worker/connection.h"
#include "worker/descriptor.h"
#include "worker/trial_runner.h"
#include "worker/worker_session.h"

namespace fatmc {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

std::string make_incarnation() {
  std::random_device device;
  std::string out;
  for (int i = 0; i < 4; ++i) {
    char digits[9];
    std::snprintf(digits, sizeof digits, "%08x", device());
    out += digits;
  }
  return out;
}

int stop_signals(bool with_interrupt) {
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGTERM);
  if (with_interrupt) sigaddset(&set, SIGINT);
  return ::signalfd(-1, &set, SFD_CLOEXEC | SFD_NONBLOCK);
}

class Worker final : private WorkerPort {
 public:
  explicit Worker(const WorkerOptions& options);
  int run();
  [[nodiscard]] bool computing() { return !runner_.idle(); }

 private:
  void send(const std::string& frame) override {
    if (!connection_.send(frame)) spdlog::debug("no connection or queue full, message dropped");
  }
  void begin(const std::shared_ptr<LoadedCampaign>& campaign, const Lease& lease) override {
    runner_.push(campaign, lease);
  }
  void drop_queue() override { runner_.clear(); }
  void note(const std::string& what) override { spdlog::info("{}", what); }
  void wait();
  void receive();
  void look_at_connection();
  void look_at_runner();
  void complain(const std::string& what) { std::fprintf(stderr, "fatmc-worker: %s\n", what.c_str()); }

  const WorkerOptions options_;
  const std::string incarnation_ = make_incarnation();
  Descriptor wake_{::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)};
  Descriptor signals_;
  Connection connection_;
  bool stop_ = false, told_of_silence_ = false;
  Clock::time_point now_ = Clock::now(), renewed_ = now_;
  std::optional<WorkerEnd> denied_;
  WorkerSession session_;
  TrialRunner runner_;  // last: its threads write to wake_
};

Worker::Worker(const WorkerOptions& options)
    : options_(options),
      signals_(stop_signals(!options.leave_after)),
      connection_(options.endpoint, incarnation_, options.keys),
      session_(Hello{kProtocolVersion, build_hash(), incarnation_, host_name(),
                     static_cast<std::uint32_t>(::getpid()), options.jobs},
               options.leave_after, *this, now_),
      runner_(options.jobs, wake_.get()) {}

void Worker::wait() {
  zmq::pollitem_t items[] = {{connection_.socket_handle(), 0, ZMQ_POLLIN, 0},
                             {connection_.event_handle(), 0, ZMQ_POLLIN, 0},
                             {nullptr, wake_.get(), ZMQ_POLLIN, 0},
                             {nullptr, signals_.get(), ZMQ_POLLIN, 0}};
  zmq::poll(items, std::size(items), session_.until_due(Clock::now()));
  now_ = Clock::now();
  stop_ = (items[3].revents & ZMQ_POLLIN) != 0;
}

void Worker::receive() {
  while (!session_.end()) {
    const std::optional<std::string> frame = connection_.receive();
    if (!frame) return;
    const Result<Message> message = decode(*frame);
    if (!message) {
      spdlog::warn("{}", message.error().text());
      continue;
    }
    spdlog::debug("received {}", message_name(*message));
    session_.on_message(*message, now_);
  }
}

void Worker::look_at_connection() {
  while (const std::optional<ConnectionEvent> event = connection_.next_event()) {
    if (*event == ConnectionEvent::connected) {
      spdlog::info("connected to {}", options_.endpoint);
      told_of_silence_ = false;
      session_.on_connected(now_);
    } else if (!session_.welcomed()) {
      // Once welcomed, it was the right coordinator, and what does not fit now came from a damaged
      // connection.
      denied_ =
          WorkerEnd{2, "not admitted",
                    *event == ConnectionEvent::refused
                        ? options_.endpoint +
                              " does not admit this worker's key; add its public key to workers.pub there"
                    : options_.keys
                        ? options_.endpoint + " takes no keys; leave out --keys, or start it with --keys DIR"
                        : options_.endpoint +
                              " wants keys; copy worker.key and coordinator.pub from its folder of "
                              "keys and add --keys DIR"};
    }
  }
  if (session_.is_deaf(now_) && now_ - renewed_ > milliseconds(2000)) {
    renewed_ = now_;
    if (!told_of_silence_ && !options_.leave_after) {
      complain("no word from " + options_.endpoint + ", trying on" +
               (options_.keys ? " (no coordinator there, or coordinator.pub is of another)" : ""));
    }
    told_of_silence_ = true;
    connection_.renew();
  }
}

void Worker::look_at_runner() {
  std::uint64_t count = 0;
  [[maybe_unused]] const auto size = ::read(wake_.get(), &count, sizeof count);
  session_.on_news(runner_.take_news(), now_);
}

int Worker::run() {
  while (!session_.end() && !denied_) {
    wait();
    if (stop_) {
      session_.leave(now_);
      break;
    }
    receive();
    look_at_connection();
    look_at_runner();
    now_ = Clock::now();
    session_.on_tick(now_);
  }
  const WorkerEnd& end = denied_ ? *denied_ : *session_.end();
  if (!end.complaint.empty()) complain(end.complaint);
  spdlog::info("worker ends: {}", end.why);
  connection_.close();
  return end.code;
}

}  // namespace

int run_worker(const WorkerOptions& options) {
  spdlog::set_default_logger(spdlog::stderr_logger_mt("worker"));
  spdlog::set_level(options.verbose ? spdlog::level::info : spdlog::level::warn);
  spdlog::cfg::load_env_levels();  // SPDLOG_LEVEL=debug: every message, too
  Worker worker(options);
  const int code = worker.run();
  // A trial may run for minutes, and nobody wants its row any more: the process ends under it.
  if (worker.computing()) std::_Exit(code);
  return code;
}

}  // namespace fatmc
