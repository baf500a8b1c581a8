#include "coordinator/cli/study_list.h"

#include <algorithm>
#include <filesystem>

#include "campaigns/base/decoder.h"
#include "coordinator/input/toml_file.h"

namespace fatmc::cli {

Result<std::vector<std::string>> listed_specs(const std::string& path) {
  const Result<Tree> tree = read_toml(path);
  if (!tree) return fail(tree.error());
  std::vector<std::string> out;
  if (tree->find("study") == nullptr) return out;
  Decoder top(*tree, "");
  for (const Tree* entry : top.tables("study")) {
    Decoder table(*entry, "study");
    const std::string name = table.text("spec");
    const std::filesystem::path own = std::filesystem::path(entry->file).parent_path() / name;
    if (!table.error() && !std::filesystem::is_regular_file(own)) {
      table.reject("spec", "no file \"" + own.lexically_normal().string() +
                               "\", write the path of a spec relative to this file");
    }
    const std::string spec = own.lexically_normal().string();
    if (std::find(out.begin(), out.end(), spec) != out.end())
      table.reject("spec", "stands twice, remove one");
    top.take(table.finish());
    out.push_back(spec);
  }
  if (Status status = top.finish(); !status) return fail(status.error());
  return out;
}

}  // namespace fatmc::cli
