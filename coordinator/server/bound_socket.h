// The coordinator's ROUTER socket, and who may connect to it.
//
// With keys it is a CURVE server that asks a ZAP handler about each connection (RFC 27): a public key that is
// not on the list is turned away in the handshake, before a byte of a message is read. CURVE alone would
// admit any key. The handler is served by the thread that serves the socket.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "proto/curve_keys.h"

namespace zmq {
class socket_t;
}

namespace fatmc {

struct SocketLimits {
  /// Connections at a time, those in handshake included; what comes beyond is closed at once.
  std::size_t connections = 4096;
  /// A handshake takes two round trips; who has not finished by then is closed.
  int handshake_ms = 5000;
  /// Messages of one connection that wait to be read; after that its TCP window closes.
  int queued_messages = 64;
};

class BoundSocket {
 public:
  /// Binds, so that a port in use is found before a database is touched; what workers send meanwhile waits.
  /// Without keys the endpoint has to be on the loopback.
  static Result<BoundSocket> bind(const std::string& endpoint = "tcp://127.0.0.1:*",
                                  const std::optional<CoordinatorKeys>& keys = std::nullopt,
                                  const SocketLimits& limits = {});
  BoundSocket(BoundSocket&&) noexcept;
  ~BoundSocket();

  /// With the port that was found for "*".
  [[nodiscard]] const std::string& endpoint() const;
  [[nodiscard]] zmq::socket_t& router();
  /// ZeroMQ sockets beside the router: when one of them is readable, serve_admission() is to be called.
  [[nodiscard]] std::vector<void*> admission_handles();
  void serve_admission();

  [[nodiscard]] std::size_t connections() const;
  /// Handshakes turned away for their key, and connections closed because there were too many.
  [[nodiscard]] std::uint64_t denied() const;
  [[nodiscard]] std::uint64_t crowded_out() const;

 private:
  struct Parts;
  explicit BoundSocket(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

}  // namespace fatmc
