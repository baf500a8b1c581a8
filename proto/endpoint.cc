#include "proto/endpoint.h"

#include <algorithm>
#include <charconv>

namespace fatmc {
namespace {

bool is_number(std::string_view text, int high) {
  int value = 0;
  const auto end = std::from_chars(text.data(), text.data() + text.size(), value);
  return !text.empty() && end.ec == std::errc() && end.ptr == text.data() + text.size() && value >= 0 &&
         value <= high;
}

bool is_loopback(std::string_view host) {
  if (host == "localhost" || host == "[::1]") return true;
  if (!host.starts_with("127.") || std::count(host.begin(), host.end(), '.') != 3) return false;
  while (!host.empty()) {
    const std::size_t dot = std::min(host.find('.'), host.size());
    if (!is_number(host.substr(0, dot), 255)) return false;
    host.remove_prefix(std::min(dot + 1, host.size()));
  }
  return true;
}

}  // namespace

Status check_endpoint(const std::string& endpoint, const std::string& option, Protection protection) {
  const std::string_view text = endpoint;
  if (text.starts_with("ipc://") && text.size() > 6) return {};
  const std::size_t colon = text.rfind(':');
  if (!text.starts_with("tcp://") || colon < 7 ||
      !(text.substr(colon + 1) == "*" || is_number(text.substr(colon + 1), 65535))) {
    return fail(Error{"", 0, option, "\"" + endpoint + "\" is no endpoint, write tcp://127.0.0.1:PORT"});
  }
  if (protection == Protection::plain && !is_loopback(text.substr(6, colon - 6))) {
    return fail(Error{"", 0, option,
                      "\"" + endpoint +
                          "\" is not on the loopback, where alone plain TCP is allowed; make keys by "
                          "`fatmc keygen DIR` and add --keys DIR, or write tcp://127.0.0.1:PORT"});
  }
  return {};
}

}  // namespace fatmc
