#include "coordinator/state/index_ranges.h"

#include <algorithm>
#include <iterator>

#include "core/base/check.h"

namespace fatmc {

void IndexRanges::insert(std::uint64_t first, std::uint64_t last) {
  if (first >= last) return;
  auto next = ranges_.upper_bound(first);
  if (next != ranges_.begin() && std::prev(next)->second >= first) --next;
  while (next != ranges_.end() && next->first <= last) {  // swallow all that overlap or touch
    first = std::min(first, next->first);
    last = std::max(last, next->second);
    size_ -= next->second - next->first;
    next = ranges_.erase(next);
  }
  ranges_.emplace_hint(next, first, last);
  size_ += last - first;
}

void IndexRanges::erase(std::uint64_t first, std::uint64_t last) {
  if (first >= last) return;
  auto next = ranges_.upper_bound(first);
  if (next != ranges_.begin() && std::prev(next)->second > first) --next;
  while (next != ranges_.end() && next->first < last) {
    const auto [low, high] = *next;
    next = ranges_.erase(next);
    size_ -= high - low;
    if (low < first) {
      ranges_.emplace(low, first);
      size_ += first - low;
    }
    if (high > last) {
      ranges_.emplace(last, high);
      size_ += high - last;
    }
  }
}

std::pair<std::uint64_t, std::uint64_t> IndexRanges::take(std::uint64_t count) {
  FATMC_CHECK(!empty() && count > 0, "nothing to take");
  const auto [low, high] = *ranges_.begin();
  const std::uint64_t last = low + std::min(count, high - low);
  erase(low, last);
  return {low, last};
}

bool IndexRanges::contains(std::uint64_t index) const {
  auto next = ranges_.upper_bound(index);
  return next != ranges_.begin() && std::prev(next)->second > index;
}

}  // namespace fatmc
