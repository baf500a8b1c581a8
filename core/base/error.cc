#include "core/base/error.h"

namespace fatmc {

std::string Error::text() const {
  std::string out;
  if (!file.empty()) {
    out += file;
    if (line > 0) out += ":" + std::to_string(line);
    out += ": ";
  }
  if (!key.empty()) out += key + ": ";
  return out + message;
}

tl::unexpected<Error> fail(std::string message) {
  Error error;
  error.message = std::move(message);
  return tl::unexpected<Error>(std::move(error));
}

}  // namespace fatmc
