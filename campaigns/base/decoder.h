// Reads a table of a Tree key by key, checks types and ranges, and reports the first thing that is wrong.
//
//   Decoder table(tree, "excitation");
//   spec.amplitude = table.real("amplitude_rad_s", {.low = 0.0, .high = 1.0});
//   spec.periods = table.integer("periods", {.low = 2, .high = 100}, 2);      // with a default
//   if (auto status = table.finish(); !status) return fail(status.error());   // also refuses unknown keys
//
// After the first error every read returns a harmless value, so that a decoding function is a plain list.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "campaigns/base/tree.h"
#include "core/base/error.h"

namespace fatmc {

/// Allowed values, ends included.
struct RealRange {
  double low = -std::numeric_limits<double>::max();
  double high = std::numeric_limits<double>::max();
};
struct IntegerRange {
  std::int64_t low = std::numeric_limits<std::int64_t>::min();
  std::int64_t high = std::numeric_limits<std::int64_t>::max();
};

class Decoder {
 public:
  /// `path` is the dotted name of the table for messages ("" at the top of a file).
  Decoder(const Tree& tree, std::string path);

  double real(std::string_view key, RealRange range = {}, std::optional<double> fallback = {});
  std::int64_t integer(std::string_view key, IntegerRange range = {},
                       std::optional<std::int64_t> fallback = {});
  bool boolean(std::string_view key, std::optional<bool> fallback = {});
  std::string text(std::string_view key, std::optional<std::string> fallback = {});
  /// One of `choices`.
  std::string choice(std::string_view key, const std::vector<std::string>& choices,
                     std::optional<std::string> fallback = {});
  /// A list of numbers; `count` > 0 fixes its length.
  std::vector<double> reals(std::string_view key, std::size_t count = 0, RealRange range = {},
                            std::optional<std::vector<double>> fallback = {});
  std::vector<std::string> texts(std::string_view key, std::optional<std::vector<std::string>> fallback = {});
  /// Rows of `columns` numbers; `rows` = 0 allows any number of rows, at least one.
  std::vector<std::vector<double>> matrix(std::string_view key, std::size_t rows, std::size_t columns,
                                          RealRange range = {});
  /// A table inside this one, or null (an error when it is required).
  const Tree* table(std::string_view key, bool required = true);
  /// The tables of an array of tables ([[key]]); empty when absent and not required.
  std::vector<const Tree*> tables(std::string_view key, bool required = true);

  /// Whether the key is there; it is known from now on, be it there or not.
  [[nodiscard]] bool has(std::string_view key);
  /// Marks a key as known without reading it (another decoder does).
  void skip(std::string_view key);
  /// Reports a value of this table as wrong.
  void reject(std::string_view key, std::string message);
  /// The full dotted name of a key.
  [[nodiscard]] std::string name(std::string_view key) const;

  [[nodiscard]] const std::optional<Error>& error() const { return error_; }
  /// Takes over the error of a nested decoder.
  void take(const Status& status);
  /// Fails on the first error, or on a key that nobody asked for (listing those that exist).
  Status finish();

 private:
  const Tree* get(std::string_view key, bool required);
  void wrong_kind(std::string_view key, const Tree& entry, std::string_view wanted);

  const Tree* tree_;
  std::string path_;
  std::vector<std::string> known_;
  std::optional<Error> error_;
};

}  // namespace fatmc
