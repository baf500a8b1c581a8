// A comparison basis as a file, so that the next diagnosis of such a record starts from it.
//
// A line "fatmc comparison basis 2", a line with the key (a hash of everything the basis depends on), matrices of doubles in
// a fixed order (rows, columns, values; little endian), and an FNV-1a hash of all that. What follows from the options alone
// (layout, candidates) is not stored.
#pragma once

#include <optional>
#include <string>

#include "core/discrepancy/comparison_basis.h"

namespace fatmc {

/// The text of the file.
std::string basis_text(const ComparisonBasis& basis, const std::string& key);

/// None where the text is not whole, is of another key or of other options.
std::optional<ComparisonBasis> parse_basis(const std::string& text, const std::string& key,
                                           const FeatureLayout& layout, const LpmGrid& grid,
                                           const BasisOptions& options);

}  // namespace fatmc
