#include "proto/key_files.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <vector>

namespace fatmc {
namespace {

constexpr const char* kCoordinatorSecret = "coordinator.key";
constexpr const char* kCoordinatorPublic = "coordinator.pub";
constexpr const char* kWorkerSecret = "worker.key";
constexpr const char* kAdmitted = "workers.pub";
constexpr std::size_t kLargestFile = std::size_t{1} << 20;

std::string in(const std::string& folder, const char* name) { return folder + "/" + name; }

tl::unexpected<Error> errno_failure(const std::string& path, const std::string& what,
                                    const std::string& remedy) {
  return fail(Error{path, 0, "", what + " (" + std::strerror(errno) + "), " + remedy});
}

struct OpenFile {
  int descriptor;
  ~OpenFile() {
    if (descriptor >= 0) ::close(descriptor);
  }
};

// `refused`: permissions of others that make the file unusable.
Result<std::string> read_guarded(const std::string& path, mode_t refused) {
  const OpenFile file{::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOCTTY | O_NONBLOCK)};
  if (file.descriptor < 0)
    return errno_failure(path, "cannot be read", "make keys by `fatmc keygen DIR` or copy them there");
  struct stat found {};
  if (::fstat(file.descriptor, &found) != 0 || !S_ISREG(found.st_mode))
    return fail(Error{path, 0, "", "is no file, make keys by `fatmc keygen DIR`"});
  if (found.st_uid != ::geteuid() && found.st_uid != 0)
    return fail(
        Error{path, 0, "", "belongs to another user, who could change it; copy it and make it yours"});
  if ((found.st_mode & refused) != 0)
    return fail(Error{path, 0, "",
                      std::string("may be ") + ((refused & S_IROTH) != 0 ? "read or written" : "written") +
                          " by others, write chmod 600 " + path +
                          ((refused & S_IROTH) != 0 ? " (and make new keys if others were there)" : "")});
  std::string text(kLargestFile + 1, '\0');
  std::size_t size = 0;
  for (ssize_t part = 0; size < text.size(); size += static_cast<std::size_t>(part)) {
    part = ::read(file.descriptor, text.data() + size, text.size() - size);
    if (part < 0) return errno_failure(path, "cannot be read", "copy it anew");
    if (part == 0) break;
  }
  if (size > kLargestFile) return fail(Error{path, 0, "", "is too large for a file of keys"});
  text.resize(size);
  return text;
}

struct KeyAndLine {
  CurveKey key;
  int line;
};

Result<std::vector<KeyAndLine>> read_keys(const std::string& path, mode_t refused) {
  const Result<std::string> text = read_guarded(path, refused);
  if (!text) return fail(text.error());
  std::vector<KeyAndLine> keys;
  int number = 0;
  for (std::size_t begin = 0; begin < text->size();) {
    ++number;
    const std::size_t end = std::min(text->find('\n', begin), text->size());
    std::string_view line(text->data() + begin, end - begin);
    begin = end + 1;
    line = line.substr(0, line.find('#'));
    const std::size_t first = line.find_first_not_of(" \t\r");
    if (first == std::string_view::npos) continue;
    line = line.substr(first, line.find_last_not_of(" \t\r") - first + 1);
    const Result<CurveKey> key = parse_key(line);
    if (!key) return fail(Error{path, number, "", key.error().message});
    keys.push_back({*key, number});
  }
  if (keys.empty()) return fail(Error{path, 0, "", "holds no key, make keys by `fatmc keygen DIR`"});
  return keys;
}

constexpr mode_t kSecret = S_IRWXG | S_IRWXO;
constexpr mode_t kOpen = S_IWGRP | S_IWOTH;

Result<CurveKey> read_one(const std::string& path, mode_t refused) {
  const Result<std::vector<KeyAndLine>> keys = read_keys(path, refused);
  if (!keys) return fail(keys.error());
  if (keys->size() > 1)
    return fail(Error{path, (*keys)[1].line, "", "is a second key where one belongs, remove it"});
  return keys->front().key;
}

// The name must be free; the file is complete or absent.
Status write_new(const std::string& path, const std::string& text) {
  const OpenFile file{::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600)};
  if (file.descriptor < 0) return errno_failure(path, "cannot be made", "name another folder");
  if (::write(file.descriptor, text.data(), text.size()) == static_cast<ssize_t>(text.size()) &&
      ::fsync(file.descriptor) == 0)
    return {};
  const tl::unexpected<Error> error = errno_failure(path, "cannot be written", "name another folder");
  ::unlink(path.c_str());
  return error;
}

}  // namespace

Status write_key_files(const std::string& folder) {
  if (::mkdir(folder.c_str(), 0700) != 0 && errno != EEXIST)
    return errno_failure(folder, "cannot be made", "name a folder inside one that exists");
  const CurvePair coordinator = make_curve_pair(), worker = make_curve_pair();
  const std::pair<const char*, std::string> files[] = {
      {kCoordinatorSecret, key_text(coordinator.secret)},
      {kCoordinatorPublic, key_text(coordinator.open)},
      {kWorkerSecret, key_text(worker.secret)},
      {kAdmitted, "# workers that the coordinator admits, a public key a line\n" + key_text(worker.open)}};
  for (const auto& [name, text] : files) {
    if (::access(in(folder, name).c_str(), F_OK) == 0) {
      return fail(Error{in(folder, name), 0, "",
                        "exists and is not overwritten, since workers may rely on it; name another folder"});
    }
  }
  std::vector<std::string> written;
  for (const auto& [name, text] : files) {
    const Status status = write_new(in(folder, name), text + "\n");
    if (!status) {
      for (const std::string& path : written) ::unlink(path.c_str());
      return status;
    }
    written.push_back(in(folder, name));
  }
  return {};
}

Result<CoordinatorKeys> read_coordinator_keys(const std::string& folder) {
  const Result<CurveKey> secret = read_one(in(folder, kCoordinatorSecret), kSecret);
  if (!secret) return fail(secret.error());
  const Result<std::vector<KeyAndLine>> admitted = read_keys(in(folder, kAdmitted), kOpen);
  if (!admitted) return fail(admitted.error());
  CoordinatorKeys keys{pair_of_secret(*secret), {}};
  for (const KeyAndLine& entry : *admitted) keys.admitted.insert(entry.key);
  return keys;
}

Result<WorkerKeys> read_worker_keys(const std::string& folder) {
  const Result<CurveKey> secret = read_one(in(folder, kWorkerSecret), kSecret);
  if (!secret) return fail(secret.error());
  const Result<CurveKey> coordinator = read_one(in(folder, kCoordinatorPublic), kOpen);
  if (!coordinator) return fail(coordinator.error());
  return WorkerKeys{pair_of_secret(*secret), *coordinator};
}

}  // namespace fatmc
