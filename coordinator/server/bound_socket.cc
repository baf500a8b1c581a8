#include "coordinator/server/bound_socket.h"

#include <spdlog/spdlog.h>
#include <sys/resource.h>
#include <sys/socket.h>

#include <algorithm>
#include <cstring>
#include <set>
#include <zmq.hpp>

#include "core/base/check.h"
#include "proto/endpoint.h"
#include "proto/wire.h"

namespace fatmc {
namespace {

constexpr int kLingerMs = 1000;
constexpr const char* kZapEndpoint = "inproc://zeromq.zap.01";  // RFC 27
constexpr const char* kMonitorEndpoint = "inproc://connections";
constexpr const char* kDomain = "fatmc";
constexpr std::size_t kDenialsToldApart = 100;  // a flood of fresh keys must not fill a log

zmq::const_buffer bytes(const CurveKey& key) { return zmq::buffer(key.data(), key.size()); }

// Each connection is a descriptor; the usual soft limit of 1024 is below what the kernel would give.
void allow_descriptors(std::size_t connections) {
  rlimit limit{};
  if (::getrlimit(RLIMIT_NOFILE, &limit) != 0) return;
  const rlim_t wanted = connections + 256;
  if (limit.rlim_cur >= wanted) return;
  limit.rlim_cur = std::min<rlim_t>(wanted, limit.rlim_max);
  ::setrlimit(RLIMIT_NOFILE, &limit);
}

std::size_t descriptors_allowed() {
  rlimit limit{};
  return ::getrlimit(RLIMIT_NOFILE, &limit) == 0 ? static_cast<std::size_t>(limit.rlim_cur) : 1024;
}

}  // namespace

struct BoundSocket::Parts {
  zmq::context_t context{1};
  // Before the router, so that it outlives it: without a handler libzmq would admit any key.
  zmq::socket_t admission{context, zmq::socket_type::rep};
  zmq::socket_t router{context, zmq::socket_type::router};
  zmq::socket_t monitor{context, zmq::socket_type::pair};
  std::string endpoint;
  std::set<CurveKey> admitted;
  std::size_t connection_limit = 0, connections = 0;
  std::uint64_t denied = 0, crowded_out = 0;
  std::set<CurveKey> told;

  ~Parts() { zmq_socket_monitor(router.handle(), nullptr, 0); }
  void protect(const CoordinatorKeys& keys);
  void watch(std::size_t limit);
  void answer_handshake();
  void count_connection();
  bool admits(const std::string& address, const zmq::message_t& key);
};

void BoundSocket::Parts::protect(const CoordinatorKeys& keys) {
  admitted = keys.admitted;
  admission.bind(kZapEndpoint);
  router.set(zmq::sockopt::curve_server, true);
  router.set(zmq::sockopt::curve_secretkey, bytes(keys.own.secret));
  router.set(zmq::sockopt::zap_domain, kDomain);
}

void BoundSocket::Parts::watch(std::size_t limit) {
  allow_descriptors(limit);
  // Enough descriptors stay for the database and for pipes of workers.
  connection_limit =
      std::min(limit, descriptors_allowed() - std::min<std::size_t>(descriptors_allowed() / 2, 128));
  const int rc =
      zmq_socket_monitor(router.handle(), kMonitorEndpoint, ZMQ_EVENT_ACCEPTED | ZMQ_EVENT_DISCONNECTED);
  FATMC_CHECK(rc == 0, "a socket can be watched");
  monitor.set(zmq::sockopt::rcvhwm, 0);  // the sender is libzmq's I/O thread, which must not wait for us
  monitor.connect(kMonitorEndpoint);
}

bool BoundSocket::Parts::admits(const std::string& address, const zmq::message_t& key) {
  CurveKey open{};
  if (key.size() != open.size()) return false;
  std::memcpy(open.data(), key.data(), open.size());
  if (admitted.contains(open)) return true;
  if (told.size() < kDenialsToldApart && told.insert(open).second)
    spdlog::warn("turned away {}: its public key {} is not admitted", address, key_text(open));
  return false;
}

// RFC 27: version, request, domain, address, routing id, mechanism, credentials.
void BoundSocket::Parts::answer_handshake() {
  std::vector<zmq::message_t> request;
  for (;;) {
    zmq::message_t part;
    if (!admission.recv(part, zmq::recv_flags::dontwait)) return;
    const bool more = part.more();
    request.push_back(std::move(part));
    if (!more) break;
  }
  const bool welcome = request.size() == 7 && request[2].to_string_view() == kDomain &&
                       request[5].to_string_view() == "CURVE" && admits(request[3].to_string(), request[6]);
  if (!welcome) ++denied;
  const std::string id = request.size() > 1 ? request[1].to_string() : std::string();
  const std::string_view parts[] = {"1.0", id, welcome ? "200" : "400", welcome ? "" : "unknown key", "", ""};
  for (std::size_t i = 0; i < std::size(parts); ++i) {
    admission.send(zmq::buffer(parts[i]),
                   i + 1 < std::size(parts) ? zmq::send_flags::sndmore : zmq::send_flags::none);
  }
}

// An event is 16 bits of kind and 32 bits of value, here the descriptor; then the endpoint.
void BoundSocket::Parts::count_connection() {
  zmq::message_t event, address;
  if (!monitor.recv(event, zmq::recv_flags::dontwait)) return;
  if (event.more()) (void)monitor.recv(address, zmq::recv_flags::dontwait);
  std::uint16_t kind = 0;
  std::int32_t descriptor = -1;
  if (event.size() != sizeof kind + sizeof descriptor) return;
  std::memcpy(&kind, event.data(), sizeof kind);
  std::memcpy(&descriptor, event.data<char>() + sizeof kind, sizeof descriptor);
  if (kind == ZMQ_EVENT_DISCONNECTED) {
    connections -= std::min<std::size_t>(connections, 1);
  } else if (kind == ZMQ_EVENT_ACCEPTED && ++connections > connection_limit) {
    if (crowded_out++ == 0) spdlog::warn("more than {} connections, closing new ones", connection_limit);
    ::shutdown(descriptor, SHUT_RDWR);  // libzmq finds it closed and lets it go
  }
}

BoundSocket::BoundSocket(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
BoundSocket::BoundSocket(BoundSocket&&) noexcept = default;
BoundSocket::~BoundSocket() = default;

const std::string& BoundSocket::endpoint() const { return parts_->endpoint; }
zmq::socket_t& BoundSocket::router() { return parts_->router; }
std::size_t BoundSocket::connections() const { return parts_->connections; }
std::uint64_t BoundSocket::denied() const { return parts_->denied; }
std::uint64_t BoundSocket::crowded_out() const { return parts_->crowded_out; }

std::vector<void*> BoundSocket::admission_handles() {
  return {parts_->admission.handle(), parts_->monitor.handle()};
}

void BoundSocket::serve_admission() {
  const auto readable = [](zmq::socket_t& socket) {
    return (socket.get(zmq::sockopt::events) & ZMQ_POLLIN) != 0;
  };
  while (readable(parts_->admission)) parts_->answer_handshake();
  while (readable(parts_->monitor)) parts_->count_connection();
}

Result<BoundSocket> BoundSocket::bind(const std::string& endpoint, const std::optional<CoordinatorKeys>& keys,
                                      const SocketLimits& limits) {
  const Protection protection = keys ? Protection::curve : Protection::plain;
  if (Status status = check_endpoint(endpoint, "--bind", protection); !status) return fail(status.error());
  auto parts = std::make_unique<Parts>();
  zmq::socket_t& router = parts->router;
  router.set(zmq::sockopt::maxmsgsize, static_cast<std::int64_t>(kMaxFrameBytes));
  router.set(zmq::sockopt::linger, kLingerMs);
  router.set(zmq::sockopt::router_handover, true);  // a worker that reconnects keeps its routing id
  router.set(zmq::sockopt::rcvhwm, limits.queued_messages);
  router.set(zmq::sockopt::handshake_ivl, limits.handshake_ms);
  router.set(zmq::sockopt::ipv6, endpoint.find('[') != std::string::npos);
  if (keys) parts->protect(*keys);
  parts->watch(limits.connections);
  try {
    router.bind(endpoint);
  } catch (const zmq::error_t& e) {
    return fail(
        Error{"", 0, "--bind", "\"" + endpoint + "\" cannot be used (" + e.what() + "), write another port"});
  }
  parts->endpoint = router.get(zmq::sockopt::last_endpoint);
  return BoundSocket(std::move(parts));
}

}  // namespace fatmc
