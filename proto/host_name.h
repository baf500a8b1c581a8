// The name of this machine, as HELLO and the provenance of a row carry it.
#pragma once

#include <string>

namespace fatmc {

/// "unknown" when the system does not tell.
std::string host_name();

}  // namespace fatmc
