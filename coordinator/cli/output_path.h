// Where a command writes: found to be writable before the work, so that an hour of it is not lost to a typing
// error.
#pragma once

#include <string>

#include "core/base/error.h"

namespace fatmc::cli {

/// `option`: the name of the option in the error. Fails where the directory `path` is a file, or cannot be made or written to. It is tried out: folders that
/// are missing are made, a file is written, and all of it is taken away again, so that a command that refuses
/// its input leaves nothing.
Status check_output_directory(const std::string& path, const std::string& option = "-o");

/// The same for a file: its folder must exist and take files, and nothing but a plain file may stand in its
/// place.
Status check_output_file(const std::string& path);

}  // namespace fatmc::cli
