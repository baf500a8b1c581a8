#include "core/base/error.h"

namespace fatmc {

namespace {

// What stands in a file may stand in a message: control characters of it must not break the line, nor reach a
// terminal.
std::string on_one_line(const std::string& text) {
  std::string out;
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (code >= 0x20 && code != 0x7f) {
      out += c;
    } else if (c == '\n') {
      out += "\\n";
    } else if (c == '\t') {
      out += "\\t";
    } else {
      static const char* const kDigits = "0123456789abcdef";
      out += "\\x";
      out += kDigits[code >> 4];
      out += kDigits[code & 15];
    }
  }
  return out;
}

}  // namespace

std::string Error::text() const {
  std::string out;
  if (!file.empty()) {
    out += file;
    if (line > 0) out += ":" + std::to_string(line);
    out += ": ";
  }
  if (!key.empty()) out += key + ": ";
  return on_one_line(out + message);
}

tl::unexpected<Error> fail(std::string message) {
  Error error;
  error.message = std::move(message);
  return tl::unexpected<Error>(std::move(error));
}

}  // namespace fatmc
