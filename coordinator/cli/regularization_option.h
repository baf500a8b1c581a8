// --regularization RULE or LAMBDA.
#pragma once

#include <string>

#include "core/base/error.h"
#include "core/subspace/pbsid_opt.h"

namespace fatmc::cli {

inline constexpr const char* kRegularizationHelp =
    "gcv (no free constant), srgcv (strong robust, smooths more), lcurve, or lambda itself";

Status read_regularization(const std::string& text, RegularizationOptions& options);

}  // namespace fatmc::cli
