// Says in what two specs differ, for a user who resumes a database by another spec.
#pragma once

#include <optional>

#include "campaigns/base/tree.h"
#include "core/base/error.h"

namespace fatmc {

/// The first value of `now` that is not in `then`, or is another, or is gone; numbers of repetitions apart.
std::optional<Error> first_difference(const Tree& now, const Tree& then);

}  // namespace fatmc
