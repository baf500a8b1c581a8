#include "proto/wire.h"

#include <algorithm>
#include <map>
#include <type_traits>

#include "core/base/check.h"
#include "proto/fatmc.pb.h"

namespace fatmc {
namespace {

constexpr std::size_t kMaxName = 512;
constexpr std::size_t kMaxText = 65536;
constexpr std::size_t kMaxLeases = 100'000;
constexpr int kMaxDepth = 64;  // protobuf's own parser stops at 100 levels, three of which are one of ours

// ---- C++ to protobuf

struct FileTable {
  std::map<std::string, std::uint32_t> index;
  pb::Welcome* welcome;
  std::uint32_t of(const std::string& file) {
    const auto [entry, is_new] = index.emplace(file, static_cast<std::uint32_t>(index.size()));
    if (is_new) welcome->add_files(file);
    return entry->second;
  }
};

void fill(const Tree& tree, FileTable& files, pb::Node& node) {
  node.set_file(files.of(tree.file));
  node.set_line(static_cast<std::uint32_t>(std::max(tree.line, 0)));
  if (const auto* table = tree.table()) {
    auto* out = node.mutable_table();
    for (const auto& [name, entry] : table->entries) {
      auto* added = out->add_entries();
      added->set_name(name);
      fill(entry, files, *added->mutable_node());
    }
  } else if (const auto* array = tree.array()) {
    auto* out = node.mutable_list();
    for (const Tree& item : array->items) fill(item, files, *out->add_items());
  } else if (const auto* text = std::get_if<std::string>(&tree.value)) {
    node.set_text(*text);
  } else if (const auto* real = std::get_if<double>(&tree.value)) {
    node.set_real(*real);
  } else if (const auto* integer = std::get_if<std::int64_t>(&tree.value)) {
    node.set_integer(*integer);
  } else {
    node.set_flag(std::get<bool>(tree.value));
  }
}

void fill(const ComputedRow& computed, pb::Row& out) {
  const TrialRow& row = computed.row;
  out.set_cell(row.key.cell);
  out.set_repetition(row.key.repetition);
  out.set_outcome(row.outcome);
  out.set_detail(row.detail);
  for (const auto& [name, value] : row.metrics) {
    auto* metric = out.add_metrics();
    metric->set_name(name);
    metric->set_value(value);
  }
  for (const auto& [name, values] : row.arrays) {
    auto* array = out.add_arrays();
    array->set_name(name);
    array->mutable_values()->Add(values.begin(), values.end());
  }
  out.set_content_hash(computed.hash.data(), computed.hash.size());
  out.set_started_us(computed.started_us);
  out.set_duration_ns(computed.duration_ns);
}

void fill(const Credit& credit, pb::Credit& out) {
  out.set_idle(credit.idle);
  out.set_queued(credit.queued);
  out.set_newest_lease(credit.newest_lease);
}

struct Encoder {
  pb::Envelope& out;
  void operator()(const Hello& m) const {
    auto* hello = out.mutable_hello();
    hello->set_protocol(m.protocol);
    hello->set_build(m.build);
    hello->set_incarnation(m.incarnation);
    hello->set_host(m.host);
    hello->set_pid(m.pid);
    hello->set_jobs(m.jobs);
  }
  void operator()(const Welcome& m) const {
    auto* welcome = out.mutable_welcome();
    welcome->set_campaign(m.campaign);
    welcome->set_heartbeat_ms(m.heartbeat_ms);
    FileTable files{{}, welcome};
    fill(m.spec, files, *welcome->mutable_spec());
  }
  void operator()(const Credit& m) const { fill(m, *out.mutable_credit()); }
  void operator()(const Lease& m) const {
    auto* lease = out.mutable_lease();
    lease->set_lease(m.lease);
    lease->set_cell(m.cell);
    lease->set_first(m.first);
    lease->set_last(m.last);
  }
  void operator()(const Results& m) const {
    auto* results = out.mutable_results();
    results->set_campaign(m.campaign);
    results->set_sequence(m.sequence);
    for (const ComputedRow& row : m.rows) fill(row, *results->add_rows());
  }
  void operator()(const Ack& m) const { out.mutable_ack()->set_sequence(m.sequence); }
  void operator()(const Heartbeat& m) const {
    auto* heartbeat = out.mutable_heartbeat();
    fill(m.credit, *heartbeat->mutable_credit());
    for (const std::uint64_t lease : m.leases) heartbeat->add_leases(lease);
  }
  void operator()(const Bye& m) const {
    out.mutable_bye()->set_reason(m.reason);
    out.mutable_bye()->set_finished(m.finished);
  }
  void operator()(const Refused& m) const {
    out.mutable_refused()->set_code(static_cast<pb::Refused::Code>(m.code));
    out.mutable_refused()->set_reason(m.reason);
  }
};

// ---- protobuf to C++, with every bound checked

tl::unexpected<Error> malformed(const std::string& what) { return fail("malformed message: " + what); }

Result<Tree> read(const pb::Node& node, const pb::Welcome& welcome, int depth) {
  if (depth > kMaxDepth) return malformed("the spec is nested too deep");
  if (node.file() >= static_cast<std::uint32_t>(welcome.files_size()))
    return malformed("no such file of the spec");
  if (node.line() > 1'000'000'000U) return malformed("a line number out of range");
  Tree tree;
  tree.file = welcome.files(static_cast<int>(node.file()));
  tree.line = static_cast<int>(node.line());
  switch (node.value_case()) {
    case pb::Node::kTable: {
      Tree::Table table;
      for (const auto& entry : node.table().entries()) {
        Result<Tree> value = read(entry.node(), welcome, depth + 1);
        if (!value) return value;
        table.entries.emplace_back(entry.name(), std::move(*value));
      }
      tree.value = std::move(table);
      return tree;
    }
    case pb::Node::kList: {
      Tree::Array array;
      for (const auto& item : node.list().items()) {
        Result<Tree> value = read(item, welcome, depth + 1);
        if (!value) return value;
        array.items.push_back(std::move(*value));
      }
      tree.value = std::move(array);
      return tree;
    }
    case pb::Node::kText:
      tree.value = node.text();
      return tree;
    case pb::Node::kReal:
      tree.value = node.real();
      return tree;
    case pb::Node::kInteger:
      tree.value = static_cast<std::int64_t>(node.integer());
      return tree;
    case pb::Node::kFlag:
      tree.value = node.flag();
      return tree;
    case pb::Node::VALUE_NOT_SET:
      break;
  }
  return malformed("a spec value of no kind");
}

Result<ComputedRow> read(const pb::Row& in) {
  ComputedRow out;
  if (in.content_hash().size() != out.hash.size()) return malformed("a content hash of a wrong size");
  std::copy(in.content_hash().begin(), in.content_hash().end(), out.hash.begin());
  if (in.outcome().empty() || in.outcome().size() > kMaxName || in.detail().size() > kMaxText) {
    return malformed("an outcome of a wrong size");
  }
  TrialRow& row = out.row;
  row.key = {in.cell(), in.repetition()};
  row.outcome = in.outcome();
  row.detail = in.detail();
  row.metrics.reserve(static_cast<std::size_t>(in.metrics_size()));
  for (const auto& metric : in.metrics()) {
    if (metric.name().empty() || metric.name().size() > kMaxName)
      return malformed("a metric without a usable name");
    row.metrics.emplace_back(metric.name(), metric.value());
  }
  row.arrays.reserve(static_cast<std::size_t>(in.arrays_size()));
  for (const auto& array : in.arrays()) {
    if (array.name().empty() || array.name().size() > kMaxName)
      return malformed("an array without a usable name");
    row.arrays.emplace_back(array.name(), std::vector<double>(array.values().begin(), array.values().end()));
  }
  out.started_us = in.started_us();
  out.duration_ns = in.duration_ns();
  if (out.started_us > std::uint64_t{1} << 62 || out.duration_ns > std::uint64_t{1} << 62) {
    return malformed("a time out of range");
  }
  if (content_hash(row) != out.hash) return malformed("a row that does not match its content hash");
  return out;
}

Credit read(const pb::Credit& in) { return {in.idle(), in.queued(), in.newest_lease()}; }

bool is_incarnation(std::string_view text) {
  return text.size() == 32 && text.find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

Result<Message> read(const pb::Hello& in) {
  if (!is_incarnation(in.incarnation())) return malformed("an incarnation that is no UUID");
  if (in.build().size() > kMaxName || in.host().size() > kMaxName)
    return malformed("a HELLO of a wrong size");
  if (in.jobs() < 1 || in.jobs() > 4096) return malformed("a number of jobs out of range");
  return Hello{in.protocol(), in.build(), in.incarnation(), in.host(), in.pid(), in.jobs()};
}

Result<Message> read(const pb::Welcome& in) {
  if (in.campaign().size() > kMaxName) return malformed("a campaign of a wrong size");
  if (in.heartbeat_ms() < 1 || in.heartbeat_ms() > 3'600'000) return malformed("a heartbeat out of range");
  Result<Tree> tree = read(in.spec(), in, 0);
  if (!tree) return fail(tree.error());
  return Welcome{in.campaign(), std::move(*tree), in.heartbeat_ms()};
}

Result<Message> read(const pb::Lease& in) {
  if (in.first() >= in.last()) return malformed("an empty lease");
  return Lease{in.lease(), in.cell(), in.first(), in.last()};
}

Result<Message> read(const pb::Results& in) {
  if (in.campaign().size() > kMaxName) return malformed("a campaign of a wrong size");
  if (static_cast<std::size_t>(in.rows_size()) > kMaxRowsPerMessage) return malformed("too many rows");
  Results out{in.campaign(), in.sequence(), {}};
  out.rows.reserve(static_cast<std::size_t>(in.rows_size()));
  for (const auto& row : in.rows()) {
    Result<ComputedRow> computed = read(row);
    if (!computed) return fail(computed.error());
    out.rows.push_back(std::move(*computed));
  }
  return out;
}

Result<Message> read(const pb::Heartbeat& in) {
  if (static_cast<std::size_t>(in.leases_size()) > kMaxLeases) return malformed("too many leases");
  return Heartbeat{read(in.credit()), {in.leases().begin(), in.leases().end()}};
}

Result<Message> read(const pb::Bye& in) {
  if (in.reason().size() > kMaxText) return malformed("a reason of a wrong size");
  return Bye{in.reason(), in.finished()};
}

Result<Message> read(const pb::Refused& in) {
  if (in.reason().size() > kMaxText) return malformed("a reason of a wrong size");
  if (!pb::Refused::Code_IsValid(in.code())) return malformed("a refusal of an unknown kind");
  return Refused{static_cast<Refused::Code>(in.code()), in.reason()};
}

}  // namespace

std::string_view message_name(const Message& message) {
  static constexpr std::string_view kNames[] = {"HELLO", "WELCOME",   "CREDIT", "LEASE",  "RESULTS",
                                                "ACK",   "HEARTBEAT", "BYE",    "REFUSED"};
  static_assert(std::size(kNames) == std::variant_size_v<Message>);
  return kNames[message.index()];
}

std::string encode(const Message& message) {
  pb::Envelope envelope;
  std::visit(Encoder{envelope}, message);
  std::string frame;
  FATMC_CHECK(envelope.SerializeToString(&frame), "a message is too large");
  return frame;
}

Result<Message> decode(std::string_view frame) {
  if (frame.size() > kMaxFrameBytes)
    return malformed("a frame of " + std::to_string(frame.size()) + " bytes");
  pb::Envelope envelope;
  if (!envelope.ParseFromArray(frame.data(), static_cast<int>(frame.size()))) return malformed("no envelope");
  switch (envelope.body_case()) {
    case pb::Envelope::kHello:
      return read(envelope.hello());
    case pb::Envelope::kWelcome:
      return read(envelope.welcome());
    case pb::Envelope::kCredit:
      return Message(read(envelope.credit()));
    case pb::Envelope::kLease:
      return read(envelope.lease());
    case pb::Envelope::kResults:
      return read(envelope.results());
    case pb::Envelope::kAck:
      return Message(Ack{envelope.ack().sequence()});
    case pb::Envelope::kHeartbeat:
      return read(envelope.heartbeat());
    case pb::Envelope::kBye:
      return read(envelope.bye());
    case pb::Envelope::kRefused:
      return read(envelope.refused());
    case pb::Envelope::BODY_NOT_SET:
      break;
  }
  return malformed("an envelope of no kind");
}

}  // namespace fatmc
