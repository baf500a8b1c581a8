// The build: SHA-256 over what can change a number (sources of core/ and campaigns/, compiler, flags,
// versions of the libraries that compute).
//
// Coordinator and workers compare it in HELLO, and a database keeps it: results of different builds never
// mix.
#pragma once

#include <string>

namespace fatmc {

std::string build_hash();

}  // namespace fatmc
