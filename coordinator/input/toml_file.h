// TOML files as located trees.
#pragma once

#include <string>

#include "campaigns/base/tree.h"
#include "core/base/error.h"

namespace fatmc {

/// Parses one file. The error carries the line of a syntax error, or says that the file cannot be read.
Result<Tree> read_toml(const std::string& path);

/// Parses a file and, wherever a table has `model = "FILE"`, `experiment = "FILE"` or
/// `published = "FILE"`, puts that file's tree in the
/// place of its name (relative to the naming file). The result needs no other file.
Result<Tree> read_toml_resolved(const std::string& path);

}  // namespace fatmc
