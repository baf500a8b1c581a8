// The socket loop against peers that do not keep to the protocol; a well-behaved worker must not notice them.
#include "tests/protocol/serving.h"

namespace fatmc {
namespace {

TEST_F(Serving, FramesThatCannotBeReadAreCountedAndDropped) {
  Peer peer(context_, endpoint_, bad_);
  peer.raw({"nonsense"});
  peer.raw({""});
  peer.raw({"two", "frames"});
  peer.raw({encode(hello(bad_)), "and more", "and more"});
  ComputedRow damaged = row(0);
  damaged.hash[0] ^= 1;
  peer.send(Results{spec_.identity(), 1, {damaged}});
  peer.send(hello(bad_));  // answered after all of the above was read
  peer.expect<Welcome>();
  finish();
  EXPECT_EQ(server_->malformed(), 5U);
}

TEST_F(Serving, AFrameAboveTheLimitClosesItsConnectionAndNothingElse) {
  Peer peer(context_, endpoint_, bad_);
  peer.raw({std::string(kMaxFrameBytes + 1, 'x')});
  finish();
}

TEST_F(Serving, AnotherBuildAndAForeignRoutingIdAreRefused) {
  Peer peer(context_, endpoint_, bad_);
  Hello other = hello(bad_);
  other.build = "another";
  peer.send(other);
  EXPECT_EQ(peer.expect<Refused>().code, Refused::Code::build);
  peer.send(hello(good_));
  EXPECT_EQ(peer.expect<Refused>().code, Refused::Code::protocol);
  peer.send(Results{spec_.identity(), 1, {row(0)}});
  EXPECT_EQ(peer.expect<Refused>().code, Refused::Code::hello_wanted);
  finish();
}

TEST_F(Serving, AWorkerMayNotSpeakAsTheCoordinator) {
  Peer peer(context_, endpoint_, bad_);
  peer.send(hello(bad_));
  peer.expect<Welcome>();
  peer.send(Lease{1, 0, 0, 2});
  peer.send(Ack{1});
  peer.send(Heartbeat{});
  peer.expect<Heartbeat>();
  finish();
  EXPECT_EQ(state_->counters().unexpected, 2U);
}

}  // namespace
}  // namespace fatmc
