// Frames from the network: decode() gives a message or an error; a message survives another trip.
#include <cstdint>

#include "proto/wire.h"
#include "tests/fuzz/input_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace fatmc;
  const Result<Message> message = decode({reinterpret_cast<const char*>(data), size});
  if (!message) {
    check_error(message.error().text());
    return 0;
  }
  const std::string frame = encode(*message);
  const Result<Message> again = decode(frame);
  if (!again || again->index() != message->index() || encode(*again) != frame) std::abort();
  return 0;
}
