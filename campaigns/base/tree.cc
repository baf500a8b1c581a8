#include "campaigns/base/tree.h"

#include <algorithm>

#include "core/base/check.h"
#include "core/base/text.h"

namespace fatmc {

const Tree* Tree::find(std::string_view key) const {
  if (const Table* entries = table()) {
    for (const auto& [name, entry] : entries->entries) {
      if (name == key) return &entry;
    }
  }
  return nullptr;
}

void Tree::set(std::string_view key, Tree entry) {
  Table* entries = std::get_if<Table>(&value);
  FATMC_CHECK(entries != nullptr, "only a table has entries");
  for (auto& [name, old] : entries->entries) {
    if (name == key) {
      old = std::move(entry);
      return;
    }
  }
  entries->entries.emplace_back(std::string(key), std::move(entry));
}

void Tree::erase(std::string_view key) {
  if (auto* entries = std::get_if<Table>(&value)) {
    std::erase_if(entries->entries, [&](const auto& entry) { return entry.first == key; });
  }
}

std::optional<double> real_value(const Tree& tree) {
  if (const auto* number = std::get_if<double>(&tree.value)) return *number;
  if (const auto* integer = std::get_if<std::int64_t>(&tree.value)) return static_cast<double>(*integer);
  return std::nullopt;
}

std::string_view kind_name(const Tree& tree) {
  static constexpr std::string_view kNames[] = {"table", "array", "string", "number", "integer", "boolean"};
  return kNames[tree.value.index()];
}

std::string with_article(std::string_view kind) {
  const bool vowel = std::string_view("aeiou").find(kind.front()) != std::string_view::npos;
  return (vowel ? "an " : "a ") + std::string(kind);
}

namespace {

void append_string(const std::string& text, std::string& out) {
  out += '"';
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  out += '"';
}

void append(const Tree& tree, std::string& out) {
  if (const auto* table = tree.table()) {
    std::vector<const std::pair<std::string, Tree>*> sorted;
    for (const auto& entry : table->entries) sorted.push_back(&entry);
    std::sort(sorted.begin(), sorted.end(), [](const auto* a, const auto* b) { return a->first < b->first; });
    out += '{';
    for (const auto* entry : sorted) {
      append_string(entry->first, out);
      out += ':';
      append(entry->second, out);
      out += ',';
    }
    out += '}';
  } else if (const auto* array = tree.array()) {
    out += '[';
    for (const Tree& item : array->items) {
      append(item, out);
      out += ',';
    }
    out += ']';
  } else if (const auto* text = std::get_if<std::string>(&tree.value)) {
    append_string(*text, out);
  } else if (const auto* number = std::get_if<double>(&tree.value)) {
    out += shortest(*number);
  } else if (const auto* integer = std::get_if<std::int64_t>(&tree.value)) {
    // 1 and 1.0 mean the same to every decoder that takes numbers.
    out += std::to_string(*integer);
  } else {
    out += std::get<bool>(tree.value) ? "true" : "false";
  }
}

}  // namespace

std::string canonical_text(const Tree& tree) {
  std::string out;
  append(tree, out);
  return out;
}

}  // namespace fatmc
