// Who gets in: with keys, those on the list alone; nobody else has a byte of a message read.
#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "tests/protocol/serving.h"

namespace fatmc {
namespace {

class Guarded : public Serving {
 protected:
  void SetUp() override { serve(keys_.coordinator, {}, {}); }
  // What the coordinator did with a peer shows in what its connection came to; a watched socket tells.
  int end_of_handshake(const std::optional<WorkerKeys>& keys) {
    zmq::socket_t socket(context_, ZMQ_DEALER), monitor(context_, ZMQ_PAIR);
    socket.set(zmq::sockopt::routing_id, bad_);
    socket.set(zmq::sockopt::linger, 0);
    if (keys) {
      const auto bytes = [](const CurveKey& key) { return zmq::buffer(key.data(), key.size()); };
      socket.set(zmq::sockopt::curve_publickey, bytes(keys->own.open));
      socket.set(zmq::sockopt::curve_secretkey, bytes(keys->own.secret));
      socket.set(zmq::sockopt::curve_serverkey, bytes(keys->coordinator));
    }
    zmq_socket_monitor(socket.handle(), "inproc://watch",
                       ZMQ_EVENT_HANDSHAKE_SUCCEEDED | ZMQ_EVENT_HANDSHAKE_FAILED_AUTH |
                           ZMQ_EVENT_HANDSHAKE_FAILED_NO_DETAIL | ZMQ_EVENT_HANDSHAKE_FAILED_PROTOCOL);
    monitor.set(zmq::sockopt::rcvtimeo, 20'000);
    monitor.connect("inproc://watch");
    socket.connect(endpoint_);
    socket.send(zmq::buffer(encode(hello(bad_))), zmq::send_flags::dontwait);
    socket.send(zmq::str_buffer("nonsense that would be counted if it were read"), zmq::send_flags::dontwait);
    zmq::message_t event, address;
    if (!monitor.recv(event)) throw std::runtime_error("no end of the handshake");
    (void)monitor.recv(address);
    std::uint16_t kind = 0;
    std::memcpy(&kind, event.data(), sizeof kind);
    zmq_socket_monitor(socket.handle(), nullptr, 0);
    return kind;
  }
  void nothing_was_read() {
    finish(keys_.worker);
    EXPECT_EQ(server_->malformed(), 0U);
    EXPECT_EQ(state_->counters().refused_hellos, 0U);
    EXPECT_EQ(state_->counters().unexpected, 0U);
  }
  const RunKeys keys_ = make_run_keys();
};

TEST_F(Guarded, AKeyOnTheListWorks) {
  finish(keys_.worker);
  EXPECT_EQ(server_->socket().denied(), 0U);
}

TEST_F(Guarded, AKeyThatIsNotOnTheListIsTurnedAwayUnread) {
  const WorkerKeys stranger{make_curve_pair(), keys_.coordinator.own.open};
  EXPECT_EQ(end_of_handshake(stranger), ZMQ_EVENT_HANDSHAKE_FAILED_AUTH);
  nothing_was_read();
  EXPECT_EQ(server_->socket().denied(), 1U);
}

TEST_F(Guarded, APeerThatExpectsAnotherCoordinatorGetsNowhere) {
  const WorkerKeys misled{keys_.worker.own, make_curve_pair().open};
  EXPECT_NE(end_of_handshake(misled), ZMQ_EVENT_HANDSHAKE_SUCCEEDED);
  nothing_was_read();
}

TEST_F(Guarded, APlainPeerGetsNowhere) {
  EXPECT_NE(end_of_handshake(std::nullopt), ZMQ_EVENT_HANDSHAKE_SUCCEEDED);
  nothing_was_read();
}

TEST_F(Guarded, AKeyThatSomebodyElseMadeFromTheSamePublicHalfIsNoKey) {
  WorkerKeys forged = keys_.worker;
  forged.own.secret = make_curve_pair().secret;
  EXPECT_NE(end_of_handshake(forged), ZMQ_EVENT_HANDSHAKE_SUCCEEDED);
  nothing_was_read();
}

class Crowded : public Serving {
 protected:
  static constexpr std::size_t kLimit = 8;
  void SetUp() override {
    SocketLimits limits;
    limits.connections = kLimit;
    serve(std::nullopt, limits, {});
  }
  // A TCP connection that says nothing; true when the other side closes it within its patience.
  int open_connection() {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    address.sin_port =
        htons(static_cast<std::uint16_t>(std::stoi(endpoint_.substr(endpoint_.rfind(':') + 1))));
    const int descriptor = ::socket(AF_INET, SOCK_STREAM, 0);
    const timeval patience{20, 0};
    ::setsockopt(descriptor, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    EXPECT_EQ(::connect(descriptor, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    return descriptor;
  }
  static bool is_closed_by_peer(int descriptor) {
    char byte[256];
    for (;;) {
      const ssize_t size = ::recv(descriptor, byte, sizeof byte, 0);
      if (size <= 0) return size == 0 || errno == ECONNRESET;
    }
  }
};

TEST_F(Crowded, ConnectionsBeyondTheLimitAreClosedAndThoseInsideWorkOn) {
  Peer worker(context_, endpoint_, good_);
  worker.send(hello(good_));
  worker.expect<Welcome>();
  std::vector<int> held;
  for (std::size_t i = 0; i < kLimit - 1; ++i) held.push_back(open_connection());
  for (int i = 0; i < 20; ++i) {
    const int extra = open_connection();
    EXPECT_TRUE(is_closed_by_peer(extra));
    ::close(extra);
  }
  worker.send(Results{spec_.identity(), 1, {row(0), row(1)}});
  worker.expect<Ack>();
  EXPECT_EQ(end_.get(), ServerEnd::finished);
  EXPECT_EQ(server_->socket().crowded_out(), 20U);
  for (const int descriptor : held) ::close(descriptor);
}

TEST_F(Crowded, ConnectionsThatEndMakeRoom) {
  for (int round = 0; round < 4; ++round) {
    std::vector<int> held;
    for (std::size_t i = 0; i < kLimit; ++i) held.push_back(open_connection());
    const int extra = open_connection();
    EXPECT_TRUE(is_closed_by_peer(extra));
    ::close(extra);
    for (const int descriptor : held) {
      ::shutdown(descriptor, SHUT_WR);
      EXPECT_TRUE(is_closed_by_peer(descriptor));
      ::close(descriptor);
    }
  }
  finish();
  EXPECT_EQ(server_->socket().crowded_out(), 4U);
}

class Flooded : public Serving {
 protected:
  void SetUp() override {
    ServerOptions options;
    options.rates.message_burst = 50.0;
    options.rates.messages_per_s = 1e-3;  // none comes back while the test runs
    serve(std::nullopt, {}, options);
  }
};

TEST_F(Flooded, MessagesBeyondTheRateOfAPeerAreDroppedUnreadAndOthersAreServed) {
  Peer flood(context_, endpoint_, bad_);
  flood.send(hello(bad_));
  flood.expect<Welcome>();
  for (int i = 0; i < 2000; ++i) flood.raw({"nonsense"});
  flood.send(hello(bad_));
  finish();
  EXPECT_LE(server_->malformed(), 49U);
}

TEST(PeerLimits, ABucketRefillsWithTimeAndKnowsBytes) {
  using std::chrono::seconds;
  PeerLimits limits(
      {.messages_per_s = 10.0, .message_burst = 20.0, .bytes_per_s = 100.0, .byte_burst = 1000.0});
  for (int i = 0; i < 20; ++i) EXPECT_TRUE(limits.admit("a", 1, seconds(0)));
  EXPECT_FALSE(limits.admit("a", 1, seconds(0)));
  EXPECT_TRUE(limits.admit("b", 1, seconds(0))) << "each peer has its own";
  for (int i = 0; i < 10; ++i) EXPECT_TRUE(limits.admit("a", 1, seconds(1)));
  EXPECT_FALSE(limits.admit("a", 1, seconds(1)));
  EXPECT_FALSE(limits.admit("b", 1001, seconds(100))) << "more bytes than it ever may send at once";
  EXPECT_TRUE(limits.admit("b", 1000, seconds(100)));
  EXPECT_FALSE(limits.admit("b", 1, seconds(100)));
  EXPECT_EQ(limits.dropped(), 4U);
  limits.forget_silent(seconds(1000));
  EXPECT_EQ(limits.peers(), 0U);
}

}  // namespace
}  // namespace fatmc
