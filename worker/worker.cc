#include "worker/worker.h"

#include <signal.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>
#include <sys/eventfd.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <random>
#include <zmq.hpp>

#include "proto/build_hash.h"
#include "proto/host_name.h"
#include "proto/wire.h"
#include "worker/descriptor.h"
#include "worker/result_outbox.h"
#include "worker/trial_runner.h"

namespace fatmc {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

constexpr milliseconds kHelloAgain{1000};
constexpr milliseconds kLinger{500};

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

class Worker {
 public:
  explicit Worker(const WorkerOptions& options);
  int run();
  [[nodiscard]] bool computing() { return !runner_.idle(); }

 private:
  void send(const Message& message) { send_frame(encode(message)); }
  void send_frame(const std::string& frame);
  void say_hello();
  void receive();
  void handle(const Message& message);
  void handle_welcome(const Welcome& welcome);
  void handle_lease(const Lease& lease);
  void handle_ack(const Ack& ack);
  void handle_refused(const Refused& refused);
  void handle_bye(const Bye& bye);
  void look_at_runner();
  void send_results(bool all);
  void send_credit();
  void do_what_is_due();
  [[nodiscard]] milliseconds until_due() const;
  void end(int code, const std::string& why);

  const WorkerOptions options_;
  const std::string incarnation_ = make_incarnation();
  const std::string host_ = host_name();
  Descriptor wake_{::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)};
  Descriptor signals_;
  zmq::context_t context_{1};
  zmq::socket_t socket_{context_, zmq::socket_type::dealer};
  std::shared_ptr<LoadedCampaign> campaign_;
  bool welcomed_ = false;
  milliseconds heartbeat_{500};
  Clock::time_point now_ = Clock::now(), last_heard_ = now_, last_hello_{}, last_beat_{};
  std::uint64_t newest_lease_ = 0;
  std::map<std::uint64_t, std::uint64_t> leases_;  // -> rows not yet acknowledged
  ResultOutbox outbox_{[this](const std::string& frame) { send_frame(frame); }};
  Credit credit_;
  std::optional<Credit> told_;
  std::optional<int> exit_;
  TrialRunner runner_;  // last: its threads write to wake_
};

Worker::Worker(const WorkerOptions& options)
    : options_(options), signals_(stop_signals(!options.leave_after)), runner_(options.jobs, wake_.get()) {
  socket_.set(zmq::sockopt::routing_id, incarnation_);
  socket_.set(zmq::sockopt::maxmsgsize, static_cast<std::int64_t>(kMaxFrameBytes));
  socket_.set(zmq::sockopt::linger, static_cast<int>(kLinger.count()));
  socket_.set(zmq::sockopt::reconnect_ivl, 50);
  socket_.set(zmq::sockopt::reconnect_ivl_max, 1000);
  socket_.set(zmq::sockopt::ipv6, options.endpoint.find('[') != std::string::npos);
  if (options.keys) {
    const auto bytes = [](const CurveKey& key) { return zmq::buffer(key.data(), key.size()); };
    socket_.set(zmq::sockopt::curve_publickey, bytes(options.keys->own.open));
    socket_.set(zmq::sockopt::curve_secretkey, bytes(options.keys->own.secret));
    socket_.set(zmq::sockopt::curve_serverkey, bytes(options.keys->coordinator));
  }
  socket_.connect(options.endpoint);
}

void Worker::send_frame(const std::string& frame) {
  // A full queue means that nobody has read for long: what is lost is sent again later.
  if (!socket_.send(zmq::buffer(frame), zmq::send_flags::dontwait))
    spdlog::debug("queue full, message dropped");
}

void Worker::say_hello() {
  welcomed_ = false;
  last_hello_ = now_;
  send(Hello{kProtocolVersion, build_hash(), incarnation_, host_, static_cast<std::uint32_t>(::getpid()),
             options_.jobs});
}

void Worker::end(int code, const std::string& why) {
  spdlog::info("worker ends: {}", why);
  exit_ = code;
}

void Worker::receive() {
  zmq::message_t frame;
  while (!exit_ && socket_.recv(frame, zmq::recv_flags::dontwait)) {
    last_heard_ = now_;
    const Result<Message> message = decode(frame.to_string_view());
    if (!message) {
      spdlog::warn("{}", message.error().text());
      continue;
    }
    handle(*message);
  }
}

void Worker::handle(const Message& message) {
  spdlog::debug("received {}", message_name(message));
  if (const auto* welcome = std::get_if<Welcome>(&message)) return handle_welcome(*welcome);
  if (const auto* lease = std::get_if<Lease>(&message)) return handle_lease(*lease);
  if (const auto* ack = std::get_if<Ack>(&message)) return handle_ack(*ack);
  if (const auto* bye = std::get_if<Bye>(&message)) return handle_bye(*bye);
  if (const auto* refused = std::get_if<Refused>(&message)) return handle_refused(*refused);
}

void Worker::handle_welcome(const Welcome& welcome) {
  if (welcomed_) return;  // the answer to a HELLO that was sent twice
  if (campaign_ == nullptr || campaign_->id() != welcome.campaign) outbox_.clear();
  // Trials leased by a coordinator that is gone are the new one's to lease. Loaded anew, since the new one
  // may plan more repetitions.
  leases_.clear();
  runner_.clear();
  Result<std::shared_ptr<LoadedCampaign>> loaded = LoadedCampaign::load(welcome.campaign, welcome.spec);
  if (!loaded) {
    std::fprintf(stderr, "fatmc-worker: %s\n", loaded.error().text().c_str());
    send(Refused{Refused::Code::unusable_spec, loaded.error().text()});
    return end(2, "unusable spec");
  }
  campaign_ = std::move(*loaded);
  heartbeat_ = milliseconds(welcome.heartbeat_ms);
  welcomed_ = true;
  newest_lease_ = 0;
  told_.reset();
  last_beat_ = now_;
  spdlog::info("welcome: campaign {}", welcome.campaign.substr(0, 12));
  outbox_.resend(false, now_);
}

void Worker::handle_lease(const Lease& lease) {
  if (!welcomed_ || !campaign_->holds(lease) || leases_.contains(lease.lease)) return;
  newest_lease_ = std::max(newest_lease_, lease.lease);
  leases_[lease.lease] = lease.last - lease.first;
  runner_.push(campaign_, lease);
}

void Worker::handle_ack(const Ack& ack) {
  for (const auto& [id, rows] : outbox_.acknowledge(ack.sequence)) {
    const auto lease = leases_.find(id);
    if (lease != leases_.end() && (lease->second -= std::min(lease->second, rows)) == 0) leases_.erase(lease);
  }
}

void Worker::handle_refused(const Refused& refused) {
  if (refused.code == Refused::Code::hello_wanted) {
    if (welcomed_) say_hello();
    return;
  }
  std::fprintf(stderr, "fatmc-worker: refused: %s\n", refused.reason.c_str());
  end(2, "refused");
}

void Worker::handle_bye(const Bye& bye) {
  if (options_.leave_after || bye.finished) return end(0, bye.reason);
  spdlog::info("coordinator left ({}), waiting for it to come back", bye.reason);
  runner_.clear();
  leases_.clear();
  welcomed_ = false;
  last_hello_ = now_;
}

void Worker::look_at_runner() {
  std::uint64_t count = 0;
  [[maybe_unused]] const auto size = ::read(wake_.get(), &count, sizeof count);
  RunnerNews news = runner_.take_news();
  if (news.failure) {
    std::fprintf(stderr, "fatmc-worker: %s\n", news.failure->reason.c_str());
    send_results(true);
    send(*news.failure);
    return end(news.failure->code == Refused::Code::unusable_spec ? 2 : 1, "a trial cannot be run");
  }
  for (FinishedRow& row : news.rows) {
    if (campaign_ != nullptr && row.campaign == campaign_->id()) outbox_.add(std::move(row));
  }
  credit_ = {news.idle, news.queued, newest_lease_};
}

void Worker::send_results(bool all) {
  if (!outbox_.has_unsent() || !welcomed_) return;
  if (all || credit_.queued == 0 || outbox_.is_due(now_)) outbox_.flush(campaign_->id(), now_);
}

void Worker::send_credit() {
  credit_.newest_lease = newest_lease_;
  if (!welcomed_ || credit_.queued > 0 || credit_ == told_) return;
  told_ = credit_;
  send(credit_);
}

void Worker::do_what_is_due() {
  now_ = Clock::now();
  if (options_.leave_after && now_ - last_heard_ > *options_.leave_after)
    return end(0, "the coordinator is gone");
  if (!welcomed_) {
    if (now_ - last_hello_ >= kHelloAgain) say_hello();
    return;
  }
  if (now_ - last_beat_ < heartbeat_) return;
  last_beat_ = now_;
  Heartbeat heartbeat{credit_, {}};
  for (const auto& [lease, rows] : leases_) heartbeat.leases.push_back(lease);
  send(heartbeat);
  outbox_.resend(true, now_);
}

milliseconds Worker::until_due() const {
  const auto ceil_ms = [](Clock::duration time) {
    return std::max(std::chrono::ceil<milliseconds>(time), milliseconds(0));
  };
  milliseconds wait = ceil_ms(welcomed_ ? last_beat_ + heartbeat_ - now_ : last_hello_ + kHelloAgain - now_);
  if (outbox_.has_unsent() && welcomed_) wait = std::min(wait, ceil_ms(outbox_.due() - now_));
  return wait;
}

int Worker::run() {
  say_hello();
  zmq::pollitem_t items[] = {{socket_.handle(), 0, ZMQ_POLLIN, 0},
                             {nullptr, wake_.get(), ZMQ_POLLIN, 0},
                             {nullptr, signals_.get(), ZMQ_POLLIN, 0}};
  while (!exit_) {
    zmq::poll(items, std::size(items), until_due());
    now_ = Clock::now();
    if ((items[2].revents & ZMQ_POLLIN) != 0) {
      send_results(true);
      send(Bye{"interrupted", false});
      end(3, "interrupted");
      break;
    }
    receive();
    if (exit_) break;
    look_at_runner();
    if (exit_) break;
    send_results(false);
    send_credit();
    do_what_is_due();
  }
  socket_.close();
  context_.close();  // waits for kLinger at most
  return *exit_;
}

}  // namespace

int run_worker(const WorkerOptions& options) {
  spdlog::set_default_logger(spdlog::stderr_logger_mt("worker"));
  spdlog::set_level(options.verbose ? spdlog::level::debug : spdlog::level::off);
  Worker worker(options);
  const int code = worker.run();
  // A trial may run for minutes, and nobody wants its row any more: the process ends under it.
  if (worker.computing()) std::_Exit(code);
  return code;
}

}  // namespace fatmc
