#include "core/base/text.h"

#include <array>
#include <charconv>
#include <cmath>

namespace fatmc {
namespace {

template <typename... Format>
std::string to_text(double value, Format... format) {
  std::array<char, 512> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value, format...);
  return std::string(buffer.data(), end.ptr);
}

}  // namespace

std::string shortest(double value) { return to_text(value); }

std::string significant(double value, int digits) {
  return to_text(value, std::chars_format::general, digits);
}

std::string fixed(double value, int decimals) { return to_text(value, std::chars_format::fixed, decimals); }

bool parse_double(std::string_view text, double& value) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t' || text.back() == '\r'))
    text.remove_suffix(1);
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  if (text.empty()) return false;
  const auto end = std::from_chars(text.data(), text.data() + text.size(), value);
  return end.ec == std::errc() && end.ptr == text.data() + text.size() && std::isfinite(value);
}

std::string join(const std::vector<std::string>& parts, std::string_view separator) {
  std::string out;
  for (const std::string& part : parts) {
    if (!out.empty()) out += separator;
    out += part;
  }
  return out;
}

}  // namespace fatmc
