#include "coordinator/store/spec_difference.h"

namespace fatmc {
namespace {

std::string text_of(const Tree& tree) {
  const std::string text = canonical_text(tree);
  return text.size() <= 40 ? text : "another " + std::string(kind_name(tree));
}

// What CampaignSpec::identity() leaves out, too.
bool is_ignored(const std::string& path, const std::string& name, int depth) {
  return (depth == 0 && (name == "published" || name == "stop" || name == "watch")) ||
         (depth == 2 && path.starts_with("cell.") && (name == "repetitions" || name == "priority"));
}

std::optional<Error> differ(const Tree& now, const Tree& then, const std::string& path, int depth);

std::optional<Error> differ_table(const Tree& now, const Tree& then, const std::string& path, int depth) {
  for (const auto& [name, entry] : now.table()->entries) {
    if (is_ignored(path, name, depth)) continue;
    const std::string key = path.empty() ? name : path + "." + name;
    const Tree* before = then.find(name);
    if (before == nullptr)
      return Error{entry.file, entry.line, key, "is new, the database was made without it"};
    if (auto found = differ(entry, *before, key, depth + 1)) return found;
  }
  for (const auto& [name, entry] : then.table()->entries) {
    if (is_ignored(path, name, depth)) continue;
    const std::string key = path.empty() ? name : path + "." + name;
    if (now.find(name) == nullptr) {
      return Error{now.file, now.line, key, "is missing, the database was made with " + text_of(entry)};
    }
  }
  return std::nullopt;
}

std::optional<Error> differ(const Tree& now, const Tree& then, const std::string& path, int depth) {
  if (now.table() != nullptr && then.table() != nullptr) return differ_table(now, then, path, depth);
  if (now.array() != nullptr && then.array() != nullptr &&
      now.array()->items.size() == then.array()->items.size()) {
    for (std::size_t i = 0; i < now.array()->items.size(); ++i) {
      const std::string key = path + "." + std::to_string(i + 1);
      if (auto found = differ(now.array()->items[i], then.array()->items[i], key, depth + 1)) return found;
    }
    return std::nullopt;
  }
  if (canonical_text(now) == canonical_text(then)) return std::nullopt;
  return Error{now.file, now.line, path,
               "is " + text_of(now) + ", the database was made with " + text_of(then)};
}

}  // namespace

std::optional<Error> first_difference(const Tree& now, const Tree& then) { return differ(now, then, "", 0); }

}  // namespace fatmc
