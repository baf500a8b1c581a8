// TOML files as located trees.
#pragma once

#include <string>

#include "campaigns/base/tree.h"
#include "core/base/error.h"

namespace fatmc {

/// Parses one file. The error carries the line of a syntax error, or says that the file cannot be read.
Result<Tree> read_toml(const std::string& path);

/// Parses a file and, wherever a table has `model`, `experiment` or `published` with a string, puts the file
/// of that name (relative to the naming file) in the place of the string. The result needs no other file.
Result<Tree> read_toml_resolved(const std::string& path);

}  // namespace fatmc
