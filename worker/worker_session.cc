#include "worker/worker_session.h"

#include <algorithm>
#include <utility>

namespace fatmc {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kHelloAgain{1000};

}  // namespace

WorkerSession::WorkerSession(Hello self, std::optional<milliseconds> leave_after, WorkerPort& port, Time now)
    : self_(std::move(self)),
      leave_after_(leave_after),
      port_(port),
      last_heard_(now),
      outbox_([this](const std::string& frame) { port_.send(frame); }) {
  credit_.idle = self_.jobs;
  say_hello(now);
}

void WorkerSession::say_hello(Time now) {
  welcomed_ = false;
  last_hello_ = now;
  send(self_);
}

void WorkerSession::on_connected(Time now) {
  if (end_) return;
  if (!welcomed_) return say_hello(now);
  // What was in the old connection may be lost; and a new coordinator says at once that it knows nobody.
  beat(now);
  outbox_.resend(false, now);
}

void WorkerSession::on_message(const Message& message, Time now) {
  if (end_) return;
  last_heard_ = now;
  if (const auto* welcome = std::get_if<Welcome>(&message)) return handle_welcome(*welcome, now);
  if (const auto* lease = std::get_if<Lease>(&message)) return handle_lease(*lease);
  if (const auto* ack = std::get_if<Ack>(&message)) return handle_ack(*ack);
  if (const auto* bye = std::get_if<Bye>(&message)) return handle_bye(*bye, now);
  if (const auto* refused = std::get_if<Refused>(&message)) return handle_refused(*refused, now);
}

void WorkerSession::handle_welcome(const Welcome& welcome, Time now) {
  if (welcomed_) return;  // the answer to a HELLO that was sent twice
  if (campaign_ == nullptr || campaign_->id() != welcome.campaign) outbox_.clear();
  // Trials leased by a coordinator that is gone are the new one's to lease. Loaded anew, since the new one
  // may plan more repetitions.
  leases_.clear();
  port_.drop_queue();
  Result<std::shared_ptr<LoadedCampaign>> loaded = LoadedCampaign::load(welcome.campaign, welcome.spec);
  if (!loaded) {
    send(Refused{Refused::Code::unusable_spec, loaded.error().text()});
    end_ = WorkerEnd{2, "unusable spec", loaded.error().text()};
    return;
  }
  campaign_ = std::move(*loaded);
  heartbeat_ = milliseconds(welcome.heartbeat_ms);
  welcomed_ = true;
  newest_lease_ = 0;
  told_.reset();
  last_beat_ = now;
  port_.note("welcome to campaign " + welcome.campaign.substr(0, 12) +
             ", sending again what is not acknowledged");
  outbox_.resend(false, now);
  send_credit();
}

void WorkerSession::handle_lease(const Lease& lease) {
  if (!welcomed_ || !campaign_->holds(lease) || leases_.contains(lease.lease)) return;
  newest_lease_ = std::max(newest_lease_, lease.lease);
  leases_[lease.lease] = lease.last - lease.first;
  port_.begin(campaign_, lease);
}

void WorkerSession::handle_ack(const Ack& ack) {
  for (const auto& [id, rows] : outbox_.acknowledge(ack.sequence)) {
    const auto lease = leases_.find(id);
    if (lease != leases_.end() && (lease->second -= std::min(lease->second, rows)) == 0) leases_.erase(lease);
  }
}

void WorkerSession::handle_refused(const Refused& refused, Time now) {
  if (refused.code == Refused::Code::hello_wanted) {
    if (!welcomed_) return;
    port_.note("the coordinator does not know this worker, beginning again");
    return say_hello(now);
  }
  end_ = WorkerEnd{2, "refused", "refused: " + refused.reason};
}

void WorkerSession::handle_bye(const Bye& bye, Time now) {
  if (leave_after_ || bye.finished) {
    send(Bye{"the coordinator said so", false});  // it waits for this, and says BYE again without
    end_ = WorkerEnd{0, bye.reason, {}};
    return;
  }
  port_.note("the coordinator left (" + bye.reason + "), waiting for it to come back");
  port_.drop_queue();
  leases_.clear();
  welcomed_ = false;
  last_hello_ = now;
}

void WorkerSession::on_news(RunnerNews news, Time now) {
  if (end_) return;
  credit_ = {news.idle, news.queued, newest_lease_};
  for (FinishedRow& row : news.rows) {
    if (campaign_ != nullptr && row.campaign == campaign_->id()) outbox_.add(std::move(row));
  }
  if (news.failure) {
    send_results(true, now);
    send(*news.failure);
    const bool unusable = news.failure->code == Refused::Code::unusable_spec;
    end_ = WorkerEnd{unusable ? 2 : 1, "a trial cannot be run", news.failure->reason};
    return;
  }
  send_results(false, now);
  send_credit();
}

void WorkerSession::send_results(bool all, Time now) {
  if (!outbox_.has_unsent() || !welcomed_) return;
  if (all || credit_.queued == 0 || outbox_.is_due(now)) outbox_.flush(campaign_->id(), now);
}

void WorkerSession::send_credit() {
  credit_.newest_lease = newest_lease_;
  if (!welcomed_ || credit_.queued > 0 || credit_ == told_) return;
  told_ = credit_;
  send(credit_);
}

void WorkerSession::beat(Time now) {
  last_beat_ = now;
  credit_.newest_lease = newest_lease_;
  Heartbeat heartbeat{credit_, {}};
  for (const auto& [lease, rows] : leases_) heartbeat.leases.push_back(lease);
  send(heartbeat);
}

void WorkerSession::on_tick(Time now) {
  if (end_) return;
  if (leave_after_ && now - last_heard_ > *leave_after_) {
    end_ = WorkerEnd{0, "the coordinator is gone", {}};
    return;
  }
  send_results(false, now);
  if (!welcomed_) {
    if (now - last_hello_ >= kHelloAgain) say_hello(now);
    return;
  }
  if (now - last_beat_ < heartbeat_ / 2) return;
  beat(now);
  outbox_.resend(true, now);
}

void WorkerSession::leave(Time now) {
  send_results(true, now);
  send(Bye{"interrupted", false});
  end_ = WorkerEnd{3, "interrupted", {}};
}

milliseconds WorkerSession::until_due(Time now) const {
  const auto ceil_ms = [](Time::duration time) {
    return std::max(std::chrono::ceil<milliseconds>(time), milliseconds(0));
  };
  milliseconds wait =
      ceil_ms(welcomed_ ? last_beat_ + heartbeat_ / 2 - now : last_hello_ + kHelloAgain - now);
  if (outbox_.has_unsent() && welcomed_) wait = std::min(wait, ceil_ms(outbox_.due() - now));
  return wait;
}

}  // namespace fatmc
