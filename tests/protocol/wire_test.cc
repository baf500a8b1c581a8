#include "proto/wire.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "proto/endpoint.h"

namespace fatmc {
namespace {

Tree leaf(auto value, int line) { return Tree{value, "spec.toml", line}; }

Tree example_tree() {
  Tree inner{Tree::Table{}, "model.toml", 1};
  inner.set("mass_kg", Tree{5.25, "model.toml", 2});
  Tree list{Tree::Array{{leaf(std::int64_t{-3}, 4), leaf(true, 5), leaf(std::string("é\xff"), 6)}},
            "spec.toml", 4};
  Tree tree{Tree::Table{}, "spec.toml", 1};
  tree.set("model", inner);
  tree.set("list", list);
  return tree;
}

ComputedRow example_row() {
  ComputedRow out;
  out.row.key = {2, 1'000'000'007};
  out.row.outcome = "diverged";
  out.row.detail = "attitude \xfe beyond the model";
  out.row.metrics = {
      {"snr", 20.5}, {"nothing", std::numeric_limits<double>::quiet_NaN()}, {"negative zero", -0.0}};
  out.row.arrays = {{"re", {1.0, 2.0, std::numeric_limits<double>::infinity()}}, {"empty", {}}};
  out.hash = content_hash(out.row);
  out.started_us = 1'700'000'000'000'000;
  out.duration_ns = 25'000'000;
  return out;
}

std::vector<Message> examples() {
  const std::string id = "0123456789abcdef0123456789abcdef";
  return {Hello{kProtocolVersion, "build", id, "host", 77, 4},
          Welcome{"campaign", example_tree(), 500},
          Credit{2, 17, 9},
          Lease{5, 1, 10, 20},
          Results{"campaign", 3, {example_row(), example_row()}},
          Ack{3},
          Heartbeat{{1, 2, 3}, {5, 6, 7}},
          Bye{"finished", true},
          Refused{Refused::Code::build, "another build"}};
}

TEST(Wire, EveryMessageComesBackAsItWasSent) {
  for (const Message& message : examples()) {
    const Result<Message> back = decode(encode(message));
    ASSERT_TRUE(back) << message_name(message) << ": " << back.error().text();
    ASSERT_EQ(back->index(), message.index());
    if (const auto* results =
            std::get_if<Results>(&message)) {  // NaN is not equal to itself: compare by hash
      const auto& other = std::get<Results>(*back);
      EXPECT_EQ(other.sequence, results->sequence);
      ASSERT_EQ(other.rows.size(), results->rows.size());
      EXPECT_EQ(content_hash(other.rows[0].row), results->rows[0].hash);
      EXPECT_EQ(other.rows[0].row.key, results->rows[0].row.key);
      EXPECT_EQ(other.rows[0].started_us, results->rows[0].started_us);
    } else {
      EXPECT_TRUE(*back == message) << message_name(message);
    }
  }
}

TEST(Wire, AnErrorInADecodedSpecStillKnowsItsFileAndLine) {
  const Result<Message> back = decode(encode(Welcome{"campaign", example_tree(), 500}));
  ASSERT_TRUE(back);
  const Tree* mass = std::get<Welcome>(*back).spec.find("model")->find("mass_kg");
  EXPECT_EQ(mass->file, "model.toml");
  EXPECT_EQ(mass->line, 2);
}

TEST(Wire, ARowThatDoesNotMatchItsHashIsRefused) {
  ComputedRow row = example_row();
  row.row.metrics[0].second = std::nextafter(20.5, 21.0);
  EXPECT_FALSE(decode(encode(Results{"campaign", 1, {row}})));
}

TEST(Wire, AnEmptyLeaseOrOneThatRunsBackwardsIsRefused) {
  EXPECT_FALSE(decode(encode(Lease{1, 0, 5, 5})));
  EXPECT_FALSE(decode(encode(Lease{1, 0, 6, 5})));
}

TEST(Wire, AHelloWithoutAUsableIncarnationOrJobsIsRefused) {
  EXPECT_FALSE(decode(encode(Hello{kProtocolVersion, "build", "me", "host", 1, 1})));
  EXPECT_FALSE(decode(encode(Hello{kProtocolVersion, "build", std::string(32, 'a'), "host", 1, 0})));
  EXPECT_FALSE(
      decode(encode(Hello{kProtocolVersion, "build", std::string(32, 'a'), std::string(9999, 'h'), 1, 1})));
}

TEST(Wire, MoreRowsThanAMessageMayHoldAreRefused) {
  Results results{"campaign", 1, std::vector<ComputedRow>(kMaxRowsPerMessage + 1, example_row())};
  EXPECT_FALSE(decode(encode(results)));
}

TEST(Wire, ASpecThatIsNestedTooDeepIsRefused) {
  Tree tree = leaf(std::int64_t{1}, 1);
  for (int i = 0; i < 2000; ++i) tree = Tree{Tree::Array{{tree}}, "spec.toml", 1};
  EXPECT_FALSE(decode(encode(Welcome{"campaign", tree, 500})));
}

TEST(Wire, AnEmptyFrameIsAnError) { EXPECT_FALSE(decode("")); }

TEST(Wire, DamagedFramesAreErrorsOrOtherMessagesButNeverCrashes) {
  std::mt19937_64 random(7);
  std::size_t errors = 0;
  for (const Message& message : examples()) {
    const std::string frame = encode(message);
    for (int i = 0; i < 3000; ++i) {
      std::string damaged = frame;
      switch (random() % 4) {
        case 0:
          damaged.resize(random() % (frame.size() + 1));
          break;
        case 1:
          damaged.insert(random() % (frame.size() + 1), 1 + random() % 8, static_cast<char>(random()));
          break;
        case 2:
          damaged.erase(random() % frame.size(), 1 + random() % 8);
          break;
        default:
          for (std::uint64_t n = 1 + random() % 4; n > 0; --n)
            damaged[random() % frame.size()] = static_cast<char>(random());
      }
      const Result<Message> back = decode(damaged);
      if (!back) {
        ++errors;
        EXPECT_FALSE(back.error().text().empty());
      } else if (const auto* results = std::get_if<Results>(&*back)) {
        for (const ComputedRow& row : results->rows) EXPECT_EQ(content_hash(row.row), row.hash);
      }
    }
  }
  EXPECT_GT(errors, 5000U);
}

TEST(Wire, RandomBytesAreNeverACrash) {
  std::mt19937_64 random(8);
  for (int i = 0; i < 20000; ++i) {
    std::string frame(random() % 200, '\0');
    for (char& c : frame) c = static_cast<char>(random());
    (void)decode(frame);
  }
}

TEST(Endpoint, OnlyTheLoopbackAndIpcAreAllowedWithoutKeys) {
  for (const char* good : {"tcp://127.0.0.1:5555", "tcp://127.0.0.1:*", "tcp://127.9.8.7:1",
                           "tcp://localhost:80", "tcp://[::1]:5555", "ipc:///tmp/socket"}) {
    EXPECT_TRUE(check_endpoint(good, "--bind", Protection::plain)) << good;
  }
  for (const char* bad :
       {"tcp://0.0.0.0:5555", "tcp://*:5555", "tcp://192.168.1.2:5555", "tcp://127.0.0.1.example.org:1",
        "tcp://127.0.0.1", "tcp://127.0.0.1:port", "tcp://127.0.0.1:70000", "tcp://127.0.0.999:1",
        "tcp://localhost.example.org:1", "udp://127.0.0.1:1", "ipc://", ""}) {
    EXPECT_FALSE(check_endpoint(bad, "--bind", Protection::plain)) << bad;
  }
}

TEST(Endpoint, WithKeysEveryHostIsAllowedAndNonsenseIsNot) {
  for (const char* good :
       {"tcp://0.0.0.0:5555", "tcp://*:*", "tcp://node7.example.org:1", "tcp://[fe80::1]:5"}) {
    EXPECT_TRUE(check_endpoint(good, "--bind", Protection::curve)) << good;
  }
  for (const char* bad : {"tcp://node7", "tcp://:5555", "udp://127.0.0.1:1", "ipc://", ""}) {
    EXPECT_FALSE(check_endpoint(bad, "--bind", Protection::curve)) << bad;
  }
}

}  // namespace
}  // namespace fatmc
