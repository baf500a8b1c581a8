#include "tests/support/fault_vfs.h"

#include <sqlite3.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <new>

namespace fatmc {
namespace {

FaultVfs* faults = nullptr;
sqlite3_vfs* system_vfs = nullptr;
sqlite3_vfs own_vfs;

struct File {
  sqlite3_file base;
  std::string* path;  // owned; SQLite's files are plain memory
};

sqlite3_file* real(sqlite3_file* file) {
  return reinterpret_cast<sqlite3_file*>(reinterpret_cast<char*>(file) + sizeof(File));
}

int write(sqlite3_file* file, const void* data, int size, sqlite3_int64 at) {
  if (faults->before) faults->before();
  return faults->write_code != 0 ? faults->write_code
                                 : real(file)->pMethods->xWrite(real(file), data, size, at);
}

int sync(sqlite3_file* file, int flags) {
  if (faults->before) faults->before();
  if (faults->sync_code != 0) return faults->sync_code;
  const int code = real(file)->pMethods->xSync(real(file), flags);
  if (code != SQLITE_OK) return code;
  const std::string& path = *reinterpret_cast<File*>(file)->path;
  std::ifstream in(path, std::ios::binary);
  faults->synced[path] = {std::istreambuf_iterator<char>(in), {}};
  return SQLITE_OK;
}

int close(sqlite3_file* file) {
  delete reinterpret_cast<File*>(file)->path;
  return real(file)->pMethods->xClose(real(file));
}

// The rest goes through as it is.
#define FORWARD(name, parameters, arguments) \
  int name parameters { return real(file)->pMethods->name arguments; }
FORWARD(xRead, (sqlite3_file * file, void* data, int size, sqlite3_int64 at), (real(file), data, size, at))
FORWARD(xTruncate, (sqlite3_file * file, sqlite3_int64 size), (real(file), size))
FORWARD(xFileSize, (sqlite3_file * file, sqlite3_int64* size), (real(file), size))
FORWARD(xLock, (sqlite3_file * file, int level), (real(file), level))
FORWARD(xUnlock, (sqlite3_file * file, int level), (real(file), level))
FORWARD(xCheckReservedLock, (sqlite3_file * file, int* out), (real(file), out))
FORWARD(xFileControl, (sqlite3_file * file, int op, void* argument), (real(file), op, argument))
FORWARD(xSectorSize, (sqlite3_file * file), (real(file)))
FORWARD(xDeviceCharacteristics, (sqlite3_file * file), (real(file)))
FORWARD(xShmMap, (sqlite3_file * file, int page, int size, int extend, void volatile** out),
        (real(file), page, size, extend, out))
FORWARD(xShmLock, (sqlite3_file * file, int offset, int n, int flags), (real(file), offset, n, flags))
FORWARD(xShmUnmap, (sqlite3_file * file, int remove), (real(file), remove))
#undef FORWARD
void xShmBarrier(sqlite3_file* file) { real(file)->pMethods->xShmBarrier(real(file)); }

const sqlite3_io_methods methods = {2,
                                    close,
                                    xRead,
                                    write,
                                    xTruncate,
                                    sync,
                                    xFileSize,
                                    xLock,
                                    xUnlock,
                                    xCheckReservedLock,
                                    xFileControl,
                                    xSectorSize,
                                    xDeviceCharacteristics,
                                    xShmMap,
                                    xShmLock,
                                    xShmBarrier,
                                    xShmUnmap,
                                    nullptr,
                                    nullptr};

int open(sqlite3_vfs*, const char* name, sqlite3_file* file, int flags, int* out_flags) {
  file->pMethods = nullptr;
  const int code = system_vfs->xOpen(system_vfs, name, real(file), flags, out_flags);
  if (code != SQLITE_OK) return code;
  reinterpret_cast<File*>(file)->path = new std::string(name == nullptr ? "" : name);
  file->pMethods = &methods;
  return SQLITE_OK;
}

int remove(sqlite3_vfs*, const char* name, int sync_folder) {
  const int code = system_vfs->xDelete(system_vfs, name, sync_folder);
  if (code == SQLITE_OK && sync_folder != 0) faults->synced.erase(name);
  return code;
}

}  // namespace

FaultVfs::FaultVfs() {
  if (faults != nullptr) std::abort();
  faults = this;
  system_vfs = sqlite3_vfs_find(nullptr);
  own_vfs = *system_vfs;
  own_vfs.pNext = nullptr;
  own_vfs.zName = "faults";
  own_vfs.szOsFile += static_cast<int>(sizeof(File));
  own_vfs.xOpen = open;
  own_vfs.xDelete = remove;
  sqlite3_vfs_register(&own_vfs, 1);
}

FaultVfs::~FaultVfs() {
  sqlite3_vfs_unregister(&own_vfs);
  sqlite3_vfs_register(system_vfs, 1);
  faults = nullptr;
}

}  // namespace fatmc
