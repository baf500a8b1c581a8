// Which endpoints are allowed: plain (unencrypted, unauthenticated) sockets stand on the loopback alone.
#pragma once

#include <string>

#include "core/base/error.h"

namespace fatmc {

enum class Protection { plain, curve };

/// With CURVE every tcp://HOST:PORT and ipc://PATH. Without, tcp://127.x.y.z:PORT, tcp://[::1]:PORT,
/// tcp://localhost:PORT and ipc://PATH pass; all else is refused, since anyone who reaches a plain port could
/// feed results to a campaign. PORT and the host may be * when binding.
Status check_endpoint(const std::string& endpoint, const std::string& option, Protection protection);

}  // namespace fatmc
