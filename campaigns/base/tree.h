// A file of values as a tree in which every value knows where it stands.
//
// coordinator/input makes it from TOML; it travels to the workers inside WELCOME; studies decode it, so that
// a wrong value is reported with its file and line wherever it is found.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace fatmc {

struct Tree {
  struct Table {
    std::vector<std::pair<std::string, Tree>> entries;  ///< in the order of the file
    bool operator==(const Table&) const = default;
  };
  struct Array {
    std::vector<Tree> items;
    bool operator==(const Array&) const = default;
  };

  std::variant<Table, Array, std::string, double, std::int64_t, bool> value;
  std::string file;  ///< as the user named it, or as the naming file resolved it
  int line = 0;      ///< from 1

  [[nodiscard]] const Table* table() const { return std::get_if<Table>(&value); }
  [[nodiscard]] const Array* array() const { return std::get_if<Array>(&value); }
  /// The entry of that name, or null when this is no table or has none.
  [[nodiscard]] const Tree* find(std::string_view key) const;
  /// Sets or replaces an entry of a table.
  void set(std::string_view key, Tree entry);
  /// Removes an entry of a table, if it is there.
  void erase(std::string_view key);

  bool operator==(const Tree&) const = default;
};

/// The value of a number or an integer.
std::optional<double> real_value(const Tree& tree);

/// "table", "array", "string", "number", "integer" or "boolean", for messages.
std::string_view kind_name(const Tree& tree);
/// "a table", "an integer", ...
std::string with_article(std::string_view kind);

/// Canonical text of the values alone, without files and lines and with sorted keys: equal for equal
/// meanings. Hashing it tells whether two specs are the same.
std::string canonical_text(const Tree& tree);

}  // namespace fatmc
