// SQLite's file system with faults: writes and syncs that fail, and what a power cut would leave.
//
// While it lives it is the default VFS of the process. It passes everything to the system's own and remembers
// of each file what it held when it was last synced: the image that is on disk for certain.
#pragma once

#include <functional>
#include <map>
#include <string>

namespace fatmc {

class FaultVfs {
 public:
  FaultVfs();
  ~FaultVfs();
  FaultVfs(const FaultVfs&) = delete;
  FaultVfs& operator=(const FaultVfs&) = delete;

  /// SQLite's result code of every write or sync from now on; 0: they work.
  int write_code = 0, sync_code = 0;
  /// Called before each write and each sync.
  std::function<void()> before;
  /// Path -> content as last synced. A file that was never synced is not in it.
  std::map<std::string, std::string> synced;
};

}  // namespace fatmc
