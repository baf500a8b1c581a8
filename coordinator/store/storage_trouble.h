// A database that cannot be written now.
#pragma once

#include <stdexcept>

namespace fatmc {

/// The database could not be written now, and may be later: disk full, I/O error, locked. Nothing of the
/// transaction is stored.
class StorageTrouble : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace fatmc
