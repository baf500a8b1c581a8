// A real server on a real socket with a database of two trials, and peers that say what a test wants.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <future>
#include <optional>
#include <string>
#include <vector>
#include <zmq.hpp>

#include "coordinator/server/campaign_server.h"
#include "proto/curve_keys.h"

namespace fatmc {

inline Tree leaf(auto value) { return Tree{std::move(value), "spec.toml", 1}; }

inline CampaignSpec two_trials() {
  Tree campaign = leaf(Tree::Table{}), cell = campaign, tree = campaign;
  campaign.set("study", leaf(std::string("s")));
  campaign.set("seed", leaf(std::int64_t{1}));
  cell.set("name", leaf(std::string("c")));
  cell.set("repetitions", leaf(std::int64_t{2}));
  tree.set("campaign", campaign);
  tree.set("cell", leaf(Tree::Array{{cell}}));
  return *decode_campaign(tree);
}

class Peer {
 public:
  Peer(zmq::context_t& context, const std::string& endpoint, const std::string& id,
       const std::optional<WorkerKeys>& keys = std::nullopt)
      : socket_(context, ZMQ_DEALER) {
    if (keys) {
      const auto bytes = [](const CurveKey& key) { return zmq::buffer(key.data(), key.size()); };
      socket_.set(zmq::sockopt::curve_publickey, bytes(keys->own.open));
      socket_.set(zmq::sockopt::curve_secretkey, bytes(keys->own.secret));
      socket_.set(zmq::sockopt::curve_serverkey, bytes(keys->coordinator));
    }
    socket_.set(zmq::sockopt::routing_id, id);
    socket_.set(zmq::sockopt::linger, 2000);
    socket_.set(zmq::sockopt::rcvtimeo, 20'000);
    socket_.connect(endpoint);
  }
  void send(const Message& message) { raw({encode(message)}); }
  void raw(const std::vector<std::string>& frames) {
    for (std::size_t i = 0; i < frames.size(); ++i) {
      socket_.send(zmq::buffer(frames[i]),
                   i + 1 < frames.size() ? zmq::send_flags::sndmore : zmq::send_flags::none);
    }
  }
  /// The next message of type T; others are passed over.
  template <typename T>
  T expect() {
    for (;;) {
      zmq::message_t frame;
      if (!socket_.recv(frame)) throw std::runtime_error("no answer");
      const Result<Message> message = decode(frame.to_string_view());
      if (message && std::holds_alternative<T>(*message)) return std::get<T>(*message);
    }
  }

 private:
  zmq::socket_t socket_;
};

class Serving : public testing::Test {
 protected:
  void SetUp() override { serve(std::nullopt, {}, {}); }
  /// With SetUp() overridden: what a test wants of the socket.
  void serve(const std::optional<CoordinatorKeys>& keys, const SocketLimits& limits,
             const ServerOptions& options) {
    // A folder of its own: ctest runs the tests of this file side by side.
    folder_ = std::filesystem::path(testing::TempDir()) /
              (std::string("hostile_peer_") + testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::remove_all(folder_);
    store_.emplace(std::move(*CampaignStore::open((folder_ / "c.db").string(), spec_, "build")));
    state_.emplace(store_->plan(spec_), Welcome{spec_.identity(), spec_.tree, 0}, "build");
    Result<BoundSocket> socket = BoundSocket::bind("tcp://127.0.0.1:*", keys, limits);
    ASSERT_TRUE(socket) << socket.error().text();
    endpoint_ = socket->endpoint();
    ServerOptions brief = options;
    brief.farewell = {};  // hostile peers answer no BYE
    server_ = std::make_unique<CampaignServer>(std::move(*socket), brief, *state_, *store_);
    end_ = std::async(std::launch::async, [this] { return server_->run({}); });
  }
  void TearDown() override {
    store_.reset();
    std::filesystem::remove_all(folder_);
  }
  Hello hello(const std::string& id) const { return {kProtocolVersion, "build", id, "host", 1, 1}; }
  ComputedRow row(std::uint64_t repetition) const {
    ComputedRow out;
    out.row.key = {0, repetition};
    out.hash = content_hash(out.row);
    return out;
  }
  // A worker that does all that is left.
  void finish(const std::optional<WorkerKeys>& keys = std::nullopt) {
    Peer worker(context_, endpoint_, good_, keys);
    worker.send(hello(good_));
    EXPECT_EQ(worker.expect<Welcome>().campaign, spec_.identity());
    worker.send(Results{spec_.identity(), 1, {row(0), row(1)}});
    EXPECT_EQ(worker.expect<Ack>().sequence, 1U);
    EXPECT_TRUE(worker.expect<Bye>().finished);
    worker.send(Bye{"BYE received", false});
    EXPECT_EQ(end_.get(), ServerEnd::finished);
  }

  const BlockedSignals blocked_;
  const std::string good_ = std::string(32, 'a'), bad_ = std::string(32, 'b');
  CampaignSpec spec_ = two_trials();
  std::filesystem::path folder_;
  zmq::context_t context_;
  std::optional<CampaignStore> store_;
  std::optional<CampaignState> state_;
  std::string endpoint_;
  std::unique_ptr<CampaignServer> server_;
  std::future<ServerEnd> end_;
};

}  // namespace fatmc
