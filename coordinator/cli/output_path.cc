#include "coordinator/cli/output_path.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <vector>

namespace fatmc::cli {
namespace {

namespace fs = std::filesystem;

/// errno of an attempt to put a file into `folder`, 0 where it went; nothing stays.
int reason_against_files(const fs::path& folder) {
  std::string name = (folder / ".fatmc-XXXXXX").string();
  const int file = ::mkstemp(name.data());
  if (file < 0) return errno;
  ::close(file);
  ::unlink(name.c_str());
  return 0;
}

/// The folders of `path` that do not exist, outermost first.
std::vector<fs::path> missing_folders(fs::path path) {
  std::vector<fs::path> out;
  std::error_code ignored;
  while (!path.empty() && !fs::exists(path, ignored)) {
    out.insert(out.begin(), path);
    if (path == path.parent_path()) break;
    path = path.parent_path();
  }
  return out;
}

}  // namespace

Status check_output_directory(const std::string& path, const std::string& option) {
  std::error_code error;
  if (path.empty()) return fail(Error{"", 0, option, "names nothing, name a directory"});
  if (fs::exists(path, error) && !fs::is_directory(path, error)) {
    return fail(Error{path, 0, option, "is a file, name a directory"});
  }
  const std::vector<fs::path> made = missing_folders(fs::absolute(path).lexically_normal());
  error.clear();
  for (const fs::path& folder : made) {
    if (!fs::create_directory(folder, error) && error) break;
  }
  const int reason = error ? error.value() : reason_against_files(path);
  for (auto folder = made.rbegin(); folder != made.rend(); ++folder) fs::remove(*folder, error);
  if (reason == 0) return {};
  return fail(
      Error{path, 0, option,
            "cannot be written to (" + std::string(std::strerror(reason)) + "), name another directory"});
}

Status check_output_file(const std::string& path) {
  std::error_code error;
  if (path.empty()) return fail(Error{"", 0, "-o", "names nothing, name a file"});
  const fs::file_status status = fs::symlink_status(path, error);
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    return fail(Error{path, 0, "-o", "is no plain file, name another"});
  }
  const fs::path folder = fs::absolute(path).lexically_normal().parent_path();
  if (!fs::is_directory(folder, error)) {
    return fail(Error{path, 0, "-o", "there is no folder " + folder.string() + ", make it or name another"});
  }
  if (const int reason = reason_against_files(folder); reason != 0) {
    return fail(
        Error{path, 0, "-o",
              "the folder cannot be written to (" + std::string(std::strerror(reason)) + "), name another"});
  }
  return {};
}

}  // namespace fatmc::cli
