#include "core/discrepancy/basis_cache.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <system_error>

#include "core/base/check.h"
#include "core/discrepancy/basis_file.h"
#include "core/record/column_file.h"

namespace fatmc {
namespace {

namespace fs = std::filesystem;

/// Held while it lives. Every lock has a descriptor of its own, so that it keeps threads apart as well as processes.
class FileLock {
 public:
  explicit FileLock(const fs::path& path)
      : descriptor_(open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, S_IRUSR | S_IWUSR)) {
    if (descriptor_ < 0) {
      trouble_ = path.string() + " cannot be opened: " + std::strerror(errno);
      return;
    }
    int result = 0;
    do result = flock(descriptor_, LOCK_EX);
    while (result != 0 && errno == EINTR);
    if (result != 0) trouble_ = path.string() + " cannot be locked: " + std::strerror(errno);
  }
  ~FileLock() {
    if (descriptor_ >= 0) close(descriptor_);
  }
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;
  [[nodiscard]] const std::string& trouble() const { return trouble_; }

 private:
  int descriptor_;
  std::string trouble_;
};

std::string file_text(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

/// Removes all but the newest bases; their locks stay, since someone may wait for one.
void prune(const fs::path& folder) {
  std::vector<std::pair<fs::file_time_type, fs::path>> bases;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    if (entry.path().extension() != ".basis") continue;
    const fs::file_time_type written = entry.last_write_time(error);
    if (!error) bases.emplace_back(written, entry.path());
  }
  std::sort(bases.rbegin(), bases.rend());
  for (std::size_t i = kMostBases; i < bases.size(); ++i) fs::remove(bases[i].second, error);
}

}  // namespace

Result<CachedBasis> cached_basis(const BasisPlace& place, const FeatureLayout& layout, const LpmGrid& grid,
                                 const BasisOptions& options,
                                 const std::function<Result<ComparisonBasis>()>& make) {
  const auto read = [&](const std::string& text) {
    return parse_basis(text, place.key, layout, grid, options);
  };
  CachedBasis out;
  const auto made_text = [&]() -> Result<std::string> {
    auto made = make();
    if (!made) return fail(made.error());
    return basis_text(*made, place.key);
  };
  const auto take = [&](const std::string& text) {
    auto basis = read(text);
    FATMC_CHECK(basis.has_value(), "a basis reads its own text");
    out.basis = std::move(*basis);
  };
  if (place.folder.empty()) {
    auto text = made_text();
    if (!text) return fail(text.error());
    take(*text);
    return out;
  }
  const fs::path folder(place.folder);
  const std::string name = "comparison-" + place.key.substr(0, 16);
  const fs::path file = folder / (name + ".basis");
  // A file that is there is whole (it is renamed when complete): readers need no lock.
  if (auto known = read(file_text(file))) return CachedBasis{std::move(*known), ""};
  std::error_code error;
  fs::create_directories(folder, error);
  const FileLock lock(folder / (name + ".lock"));
  out.trouble = lock.trouble();
  if (auto known = read(file_text(file))) return CachedBasis{std::move(*known), ""};
  auto text = made_text();
  if (!text) return fail(text.error());
  try {
    write_file_atomically(file.string(), *text);
    prune(folder);
  } catch (const std::system_error& e) {
    out.trouble = e.what();
  }
  take(*text);
  return out;
}

}  // namespace fatmc
