// Where plain (unencrypted, unauthenticated) sockets may stand.
#pragma once

#include <string>

#include "core/base/error.h"

namespace fatmc {

/// tcp://127.x.y.z:PORT, tcp://[::1]:PORT, tcp://localhost:PORT (PORT may be * when binding) and ipc://PATH
/// pass; all else is refused, since anyone who reaches a plain port could feed results to a campaign.
Status check_plain_endpoint(const std::string& endpoint, const std::string& option);

}  // namespace fatmc
