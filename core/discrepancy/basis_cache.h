// A comparison basis that processes of one host share: a file a key in a folder.
//
// Who needs a basis takes the lock of its key, looks for the file, and makes basis and file where there is none; others wait
// for the lock and read. The lock is the kernel's (flock) and goes with the process that holds it, so that a killed maker leaves
// nothing behind but work to do.
//
// What is returned has always gone through the file's text, in the process that made it as well, so that a result cannot
// depend on who made the basis, nor on whether there is a folder at all.
#pragma once

#include <functional>
#include <string>

#include "core/discrepancy/comparison_basis.h"

namespace fatmc {

struct BasisPlace {
  std::string folder;  ///< empty: nothing is shared
  std::string key;     ///< hexadecimal hash of everything the basis depends on, this build included
};

struct CachedBasis {
  ComparisonBasis basis;
  std::string trouble;  ///< why it could not be locked or kept, a sentence; empty: it was
};

/// `make` runs where the folder has no basis of that key for this layout, grid and options; its failure is the result's. The
/// folder is created; it keeps the kMostBases files that were written last.
inline constexpr int kMostBases = 32;
Result<CachedBasis> cached_basis(const BasisPlace& place, const FeatureLayout& layout, const LpmGrid& grid,
                                 const BasisOptions& options,
                                 const std::function<Result<ComparisonBasis>()>& make);

}  // namespace fatmc
