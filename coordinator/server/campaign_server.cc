#include "coordinator/server/campaign_server.h"

#include <signal.h>
#include <spdlog/spdlog.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <optional>
#include <utility>
#include <zmq.hpp>

#include "core/base/check.h"
#include "proto/host_name.h"

namespace fatmc {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::uint64_t kMalformedTold = 20;  // later ones are counted alone
constexpr int kTicksOfAbsence = 3;
constexpr const char* kFinished = "the campaign is finished";
constexpr int kMessagesBetweenLooks = 256;  // at signals and clocks, when messages never end

sigset_t served_signals() {
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGINT);
  sigaddset(&set, SIGTERM);
  sigaddset(&set, SIGCHLD);
  return set;
}

int open_signals() {
  const sigset_t set = served_signals();
  return ::signalfd(-1, &set, SFD_CLOEXEC | SFD_NONBLOCK);
}

MonotonicTime now() { return Clock::now().time_since_epoch(); }

struct Letter {
  WorkerId from;
  zmq::message_t frame;
  bool is_whole = false;  // an id and one frame, as all messages of the protocol
};

// Nothing when none is there.
std::optional<Letter> next_letter(zmq::socket_t& socket) {
  zmq::message_t id;
  if (!socket.recv(id, zmq::recv_flags::dontwait)) return std::nullopt;
  Letter letter{id.to_string(), {}, false};
  if (!id.more() || !socket.recv(letter.frame, zmq::recv_flags::dontwait)) return letter;
  letter.is_whole = !letter.frame.more();
  for (bool more = letter.frame.more(); more;) {
    zmq::message_t rest;
    more = socket.recv(rest, zmq::recv_flags::dontwait) && rest.more();
  }
  return letter;
}

}  // namespace

BlockedSignals::BlockedSignals() {
  const sigset_t set = served_signals();
  pthread_sigmask(SIG_BLOCK, &set, &before_);
}

BlockedSignals::~BlockedSignals() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }

struct CampaignServer::Parts {
  BoundSocket bound;
  zmq::socket_t& socket;
  int signals = open_signals();
  explicit Parts(BoundSocket given) : bound(std::move(given)), socket(bound.router()) {}
  ~Parts() { ::close(signals); }
};

CampaignServer::CampaignServer(BoundSocket socket, const ServerOptions& options, CampaignState& state,
                               CampaignStore& store)
    : options_(options),
      state_(state),
      store_(store),
      parts_(std::make_unique<Parts>(std::move(socket))),
      commits_(options.commits, [this](std::span<StoreRequest> batch) { return write(batch); }),
      limits_(options.rates) {
  FATMC_CHECK(parts_->signals >= 0, "out of file descriptors");
}

CampaignServer::~CampaignServer() = default;

const BoundSocket& CampaignServer::socket() const { return parts_->bound; }

void CampaignServer::send(const WorkerId& worker, const Message& message) {
  spdlog::debug("to {}: {}", worker.substr(0, 8), message_name(message));
  zmq::socket_t& socket = parts_->socket;
  // A worker that is gone or does not read: ROUTER drops the message, and leases expire.
  if (socket.send(zmq::buffer(worker), zmq::send_flags::sndmore | zmq::send_flags::dontwait)) {
    socket.send(zmq::buffer(encode(message)), zmq::send_flags::dontwait);
  }
}

void CampaignServer::note(const std::string& what) { spdlog::info("{}", what); }

// Rows may have gone out of the plan while they waited.
std::vector<StoreReport> CampaignServer::write(std::span<StoreRequest> batch) {
  for (StoreRequest& request : batch) state_.drop_out_of_plan(request);
  std::vector<StoreReport> reports = store_.commit(batch);
  committed_.assign(std::make_move_iterator(batch.begin()), std::make_move_iterator(batch.end()));
  return reports;
}

void CampaignServer::store(StoreRequest request) { commits_.add(std::move(request), now()); }

void CampaignServer::commit() {
  const bool was_in_trouble = !commits_.trouble().empty();
  const std::vector<StoreReport> reports = commits_.commit(now());
  for (std::size_t i = 0; i < reports.size(); ++i) {
    state_.on_stored(reports[i], now(), *this);
    if (hooks_ != nullptr && hooks_->on_committed) hooks_->on_committed(committed_[i], reports[i]);
  }
  const bool is_in_trouble = !commits_.trouble().empty();
  if (is_in_trouble == was_in_trouble) return;
  if (is_in_trouble) {
    spdlog::warn(
        "the database cannot be written ({}): no trial is handed out until it can; make room on its disk",
        commits_.trouble());
    return state_.hold_dispatch();
  }
  spdlog::warn("the database takes rows again, work goes on");
  state_.release_dispatch(now(), *this);
}

void CampaignServer::set_repetitions(std::uint32_t cell, std::uint64_t repetitions) {
  state_.set_repetitions(cell, repetitions, now(), *this);
}

void CampaignServer::set_paused(bool paused) {
  if (paused) {
    state_.pause();
  } else {
    state_.resume(now(), *this);
  }
}

void CampaignServer::receive() {
  for (int i = 0; i < kMessagesBetweenLooks; ++i) {
    const std::optional<Letter> letter = next_letter(parts_->socket);
    if (!letter) return;
    if (!letter->is_whole) {
      ++malformed_;
      continue;
    }
    if (!limits_.admit(letter->from, letter->frame.size(), now())) continue;
    Result<Message> message = decode(letter->frame.to_string_view());
    if (!message) {
      if (malformed_++ < kMalformedTold) spdlog::warn("{}", message.error().text());
      continue;
    }
    // While rows cannot be kept, their workers keep them; memory would not.
    if (!commits_.trouble().empty() && std::holds_alternative<Results>(*message)) continue;
    spdlog::debug("from {}: {}", letter->from.substr(0, 8), message_name(*message));
    state_.on_message(letter->from, std::move(*message), now(), *this);
    if (commits_.is_full(now()) || (state_.all_received() && commits_.may_try(now()))) commit();
  }
}

std::chrono::milliseconds CampaignServer::wait_time() const {
  return commits_.empty() ? options_.tick : std::min(commits_.until_due(now()), options_.tick);
}

CampaignServer::Signals CampaignServer::wait(std::chrono::milliseconds time) {
  std::vector<zmq::pollitem_t> items{{parts_->socket.handle(), 0, ZMQ_POLLIN, 0},
                                     {nullptr, parts_->signals, ZMQ_POLLIN, 0}};
  for (void* handle : parts_->bound.admission_handles()) items.push_back({handle, 0, ZMQ_POLLIN, 0});
  zmq::poll(items, time);
  parts_->bound.serve_admission();
  Signals out;
  signalfd_siginfo signal{};
  while (::read(parts_->signals, &signal, sizeof signal) == sizeof signal)
    (signal.ssi_signo == SIGCHLD ? out.child : out.interrupted) = true;
  return out;
}

void CampaignServer::tick(MonotonicTime last) {
  // A commit on a slow disk, or a process that was stopped: nobody was listened to meanwhile, and what they
  // said may still be on its way from the kernel.
  if (now() - last > kTicksOfAbsence * options_.tick) state_.on_absence(now() - last - options_.tick, now());
  state_.on_tick(now(), *this);
  limits_.forget_silent(now());
  if (hooks_->on_tick) hooks_->on_tick();
}

ServerEnd CampaignServer::run(const ServerHooks& hooks) {
  hooks_ = &hooks;
  MonotonicTime last_tick = now();
  ServerEnd end = ServerEnd::finished;
  while (!state_.finished()) {
    const Signals signals = wait(wait_time());
    if (signals.child && hooks.on_child) hooks.on_child();
    receive();
    if (commits_.is_due(now())) commit();
    if (now() - last_tick >= options_.tick) {
      const MonotonicTime last = std::exchange(last_tick, now());
      tick(last);
    }
    if (signals.interrupted) {
      end = ServerEnd::interrupted;
      break;
    }
    if (hooks.failure && !hooks.failure().empty()) {
      end = ServerEnd::failed;
      break;
    }
  }
  commit();
  hooks_ = nullptr;
  if (state_.finished()) end = ServerEnd::finished;
  say_bye(end == ServerEnd::finished);
  if (end == ServerEnd::finished) see_off();
  return end;
}

void CampaignServer::say_bye(bool finished) {
  for (const WorkerId& worker : state_.workers()) {
    send(worker, Bye{finished ? kFinished : "the coordinator stops", finished});
  }
}

// A worker whose connection broke, or that made another since it heard nothing for long, has missed its BYE;
// it speaks when the new one stands.
void CampaignServer::see_off() {
  const MonotonicTime end = now() + options_.farewell;
  while (!state_.workers().empty() && now() < end) {
    if (wait(options_.tick).interrupted) return;
    while (const std::optional<Letter> letter = next_letter(parts_->socket)) {
      const Result<Message> message = decode(letter->frame.to_string_view());
      if (!letter->is_whole || !message) continue;
      if (std::holds_alternative<Bye>(*message)) {
        state_.on_gone(letter->from, {}, now(), *this);
      } else {
        send(letter->from, Bye{kFinished, true});
      }
    }
  }
}

void CampaignServer::on_process_ended(std::uint32_t pid, const std::string& how) {
  for (const WorkerId& worker : state_.workers_of_pid(pid, host_name()))
    state_.on_gone(worker, how, now(), *this);
}

}  // namespace fatmc
