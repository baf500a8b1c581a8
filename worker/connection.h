// A worker's connection to its coordinator, made anew when it breaks or falls silent.
//
// libzmq reconnects by itself after a broken connection, but not after one whose bytes made no sense, and a
// connection whose packets are lost in silence lives for many minutes. So the owner asks for a new one when
// it has heard nothing for long.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "core/base/error.h"
#include "proto/curve_keys.h"

namespace zmq {
class socket_t;
}

namespace fatmc {

enum class ConnectionEvent {
  connected,  ///< the handshake is done
  refused,    ///< the coordinator does not admit this worker's key
  mismatch    ///< one side has keys and the other has not, or the coordinator is another one
};

class Connection {
 public:
  Connection(std::string endpoint, std::string routing_id, std::optional<WorkerKeys> keys);
  ~Connection();
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  /// Closes the connection, what is queued in it is lost, and begins another under the same routing id.
  void renew();
  /// False when it was dropped, since nobody reads or there is no connection.
  bool send(const std::string& frame);
  std::optional<std::string> receive();
  std::optional<ConnectionEvent> next_event();
  /// For polling; they change with renew().
  [[nodiscard]] void* socket_handle();
  [[nodiscard]] void* event_handle();
  /// Waits a moment for what was sent to leave.
  void close();

 private:
  struct Parts;
  void open();
  const std::string endpoint_, routing_id_;
  const std::optional<WorkerKeys> keys_;
  std::unique_ptr<Parts> parts_;
};

}  // namespace fatmc
