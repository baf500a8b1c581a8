// Joins databases of one campaign whose trials were computed apart.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/base/error.h"

namespace fatmc {

struct MergeReport {
  std::uint64_t added = 0;       ///< rows that the output did not have
  std::uint64_t duplicates = 0;  ///< rows that it had, with the same content hash
  std::uint64_t stored = 0;      ///< rows of the output now
  std::uint64_t planned = 0;     ///< trials of the plan: the largest numbers of repetitions of all
};

/// Adds the rows of `shards` to `output`, which is made where there is none, in one transaction: an Error or
/// an exception leaves it as it was. All must have the same spec, seed and build; figures to compare with are
/// those of the first shard. Each row is compared with its content hash; a trial with two different results
/// is an Error that names it. `progress` is told the index of each shard before it is read.
Result<MergeReport> merge_shards(const std::string& output, const std::vector<std::string>& shards,
                                 const std::function<void(std::size_t)>& progress = {});

}  // namespace fatmc
