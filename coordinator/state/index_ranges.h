// A set of indices, kept as disjoint ranges: a million stored trials are one entry.
#pragma once

#include <cstdint>
#include <map>
#include <utility>

namespace fatmc {

class IndexRanges {
 public:
  /// Adds [first, last); parts that are in already stay.
  void insert(std::uint64_t first, std::uint64_t last);
  void insert(std::uint64_t index) { insert(index, index + 1); }
  /// Removes [first, last), whatever of it is in.
  void erase(std::uint64_t first, std::uint64_t last);
  void erase(std::uint64_t index) { erase(index, index + 1); }
  /// Removes and returns the first `count` indices that are neighbours, fewer when the first range is
  /// shorter.
  std::pair<std::uint64_t, std::uint64_t> take(std::uint64_t count);

  [[nodiscard]] bool contains(std::uint64_t index) const;
  [[nodiscard]] std::uint64_t size() const { return size_; }
  [[nodiscard]] bool empty() const { return size_ == 0; }
  /// First index -> one past the last.
  [[nodiscard]] const std::map<std::uint64_t, std::uint64_t>& ranges() const { return ranges_; }

 private:
  std::map<std::uint64_t, std::uint64_t> ranges_;
  std::uint64_t size_ = 0;
};

}  // namespace fatmc
