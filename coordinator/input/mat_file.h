// Channels of a MAT file as columns: level 5 and 4 (also compressed), and 7.3, which is HDF5.
#pragma once

#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/record/column_file.h"

namespace fatmc {

struct MatChannels {
  Columns columns;  ///< the wanted channels that exist, under the names they were wanted by
  std::vector<std::string> variables;  ///< what the file holds, for the message that a channel does not exist
};

/// A channel is `name` for a vector (row or column) or `name(k)` for column k, from 1, of a matrix of samples
/// x channels; real numbers of any numeric class, or logical. Names that the file lacks are left out. The
/// channel t (time) may be wanted without need: it is left out where it is no vector of the others' length.
/// The error names the variable: complex, a struct, cell, text or sparse matrix, empty, a matrix without
/// index, an index outside, a length unlike the others'.
Result<MatChannels> read_mat_channels(const std::string& path, const std::vector<std::string>& wanted);

/// The path ends in .mat.
bool is_mat_file(const std::string& path);

}  // namespace fatmc
