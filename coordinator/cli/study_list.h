// A spec that is a list of specs:
//
//   [[study]]
//   spec = "coverage/spec.toml"      # relative to this file
#pragma once

#include <string>
#include <vector>

#include "core/base/error.h"

namespace fatmc::cli {

/// The paths of the specs that `path` lists, in their order; none where it is a spec itself.
Result<std::vector<std::string>> listed_specs(const std::string& path);

}  // namespace fatmc::cli
