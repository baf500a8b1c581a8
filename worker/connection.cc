#include "worker/connection.h"

#include <cstring>
#include <utility>
#include <zmq.hpp>

#include "core/base/check.h"
#include "proto/wire.h"

namespace fatmc {
namespace {

constexpr int kLingerMs = 500;
constexpr int kReconnectMs = 50;      // a coordinator that comes back is found at once
constexpr int kReconnectMaxMs = 250;  // one that stays away is asked four times a second
constexpr int kHandshakeMs = 5000;
constexpr int kEvents =
    ZMQ_EVENT_HANDSHAKE_SUCCEEDED | ZMQ_EVENT_HANDSHAKE_FAILED_AUTH | ZMQ_EVENT_HANDSHAKE_FAILED_PROTOCOL;

}  // namespace

struct Connection::Parts {
  zmq::context_t context{1};
  std::optional<zmq::socket_t> socket, monitor;
  std::uint64_t opened = 0;
};

Connection::Connection(std::string endpoint, std::string routing_id, std::optional<WorkerKeys> keys)
    : endpoint_(std::move(endpoint)),
      routing_id_(std::move(routing_id)),
      keys_(std::move(keys)),
      parts_(std::make_unique<Parts>()) {
  open();
}

Connection::~Connection() = default;

void Connection::open() {
  zmq::socket_t& socket = parts_->socket.emplace(parts_->context, zmq::socket_type::dealer);
  socket.set(zmq::sockopt::routing_id, routing_id_);
  socket.set(zmq::sockopt::maxmsgsize, static_cast<std::int64_t>(kMaxFrameBytes));
  socket.set(zmq::sockopt::linger, kLingerMs);
  socket.set(zmq::sockopt::reconnect_ivl, kReconnectMs);
  socket.set(zmq::sockopt::reconnect_ivl_max, kReconnectMaxMs);
  socket.set(zmq::sockopt::handshake_ivl, kHandshakeMs);
  // Nothing is queued for a coordinator that is away: it would be old news when it returns.
  socket.set(zmq::sockopt::immediate, true);
  socket.set(zmq::sockopt::ipv6, endpoint_.find('[') != std::string::npos);
  if (keys_) {
    const auto bytes = [](const CurveKey& key) { return zmq::buffer(key.data(), key.size()); };
    socket.set(zmq::sockopt::curve_publickey, bytes(keys_->own.open));
    socket.set(zmq::sockopt::curve_secretkey, bytes(keys_->own.secret));
    socket.set(zmq::sockopt::curve_serverkey, bytes(keys_->coordinator));
  }
  const std::string name = "inproc://connection" + std::to_string(++parts_->opened);
  FATMC_CHECK(zmq_socket_monitor(socket.handle(), name.c_str(), kEvents) == 0, "a socket can be watched");
  parts_->monitor.emplace(parts_->context, zmq::socket_type::pair);
  parts_->monitor->set(zmq::sockopt::rcvhwm, 0);  // the sender is libzmq's I/O thread, which must not wait
  parts_->monitor->set(zmq::sockopt::linger, 0);
  parts_->monitor->connect(name);
  socket.connect(endpoint_);
}

void Connection::renew() {
  parts_->socket->set(zmq::sockopt::linger, 0);
  parts_->socket.reset();
  parts_->monitor.reset();
  open();
}

bool Connection::send(const std::string& frame) {
  return parts_->socket->send(zmq::buffer(frame), zmq::send_flags::dontwait).has_value();
}

std::optional<std::string> Connection::receive() {
  zmq::message_t frame;
  if (!parts_->socket->recv(frame, zmq::recv_flags::dontwait)) return std::nullopt;
  return frame.to_string();
}

std::optional<ConnectionEvent> Connection::next_event() {
  for (;;) {
    zmq::message_t event, address;
    if (!parts_->monitor->recv(event, zmq::recv_flags::dontwait)) return std::nullopt;
    if (event.more()) (void)parts_->monitor->recv(address, zmq::recv_flags::none);
    std::uint16_t kind = 0;
    std::uint32_t value = 0;
    if (event.size() != sizeof kind + sizeof value) continue;
    std::memcpy(&kind, event.data(), sizeof kind);
    std::memcpy(&value, event.data<char>() + sizeof kind, sizeof value);
    if (kind == ZMQ_EVENT_HANDSHAKE_SUCCEEDED) {
      // Asking makes the socket see its new pipe; without, what is sent now would find none and be dropped.
      (void)parts_->socket->get(zmq::sockopt::events);
      return ConnectionEvent::connected;
    }
    if (kind == ZMQ_EVENT_HANDSHAKE_FAILED_AUTH) return ConnectionEvent::refused;
    if (kind == ZMQ_EVENT_HANDSHAKE_FAILED_PROTOCOL && value == ZMQ_PROTOCOL_ERROR_ZMTP_MECHANISM_MISMATCH)
      return ConnectionEvent::mismatch;
  }
}

void* Connection::socket_handle() { return parts_->socket->handle(); }
void* Connection::event_handle() { return parts_->monitor->handle(); }

void Connection::close() {
  zmq_socket_monitor(parts_->socket->handle(), nullptr, 0);
  parts_->monitor.reset();
  parts_->socket.reset();
  parts_->context.close();  // waits for kLingerMs at most
}

}  // namespace fatmc
