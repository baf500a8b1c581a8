// What a trial leaves behind.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace fatmc {

/// A trial within a campaign. The cell is an index into CampaignSpec::cells.
struct TrialKey {
  std::uint32_t cell = 0;
  std::uint64_t repetition = 0;
  auto operator<=>(const TrialKey&) const = default;
};

/// The result of one trial: a pure function of spec and key. Hosts, times and attempts are no part of it.
struct TrialRow {
  TrialKey key;
  /// "ok", or the name of an expected failure such as "diverged": counted in every denominator.
  std::string outcome = "ok";
  std::string detail;                                               ///< one line on a failure; empty when ok
  std::vector<std::pair<std::string, double>> metrics;              ///< scalars, by name
  std::vector<std::pair<std::string, std::vector<double>>> arrays;  ///< per line, per element ...; by name

  [[nodiscard]] const std::vector<double>* array(std::string_view name) const;
  bool operator==(const TrialRow&) const = default;
};

/// The array or metric that every row of its study with outcome "ok" holds; a missing one is a broken invariant.
const std::vector<double>& array_of(const TrialRow& row, std::string_view name);
double metric_of(const TrialRow& row, std::string_view name);

using Sha256 = std::array<std::uint8_t, 32>;

/// SHA-256 of the row: key, outcome, detail, metrics and arrays as bits (little endian, lengths in front), so
/// that two rows have one hash exactly when they are bit-identical.
Sha256 content_hash(const TrialRow& row);

/// SHA-256 of text; used for specs and builds.
Sha256 sha256(std::string_view bytes);

std::string hex(const Sha256& hash);

/// The same rows give the same digest in whatever order they were computed: feed them in the order of their
/// keys.
class Digest {
 public:
  Digest();
  /// `cell_name` makes the digest independent of how cells are numbered.
  void add(std::string_view cell_name, const TrialRow& row);
  /// 64 hexadecimal digits.
  [[nodiscard]] std::string text() const;

 private:
  Sha256 chain_{};
};

}  // namespace fatmc
