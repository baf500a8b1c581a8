#include "coordinator/cli/trial_name.h"

#include <charconv>

#include "core/base/text.h"

namespace fatmc::cli {
namespace {

constexpr std::size_t kNamesShown = 8;

}  // namespace

Result<std::uint32_t> find_cell(const CampaignSpec& spec, const std::string& name,
                                const std::string& option) {
  std::vector<std::string> names;
  for (std::uint32_t i = 0; i < spec.cells.size(); ++i) {
    if (spec.cells[i].name == name) return i;
    names.push_back("\"" + spec.cells[i].name + "\"");
  }
  const bool more = names.size() > kNamesShown;
  if (more) names.resize(kNamesShown);
  return fail(
      Error{"", 0, option, "no cell \"" + name + "\", write one of: " + join(names) + (more ? ", ..." : "")});
}

Result<TrialKey> parse_trial(const CampaignSpec& spec, const std::string& text) {
  const std::size_t slash = text.rfind('/');
  const std::string number = slash == std::string::npos ? text : text.substr(slash + 1);
  TrialKey key;
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), key.repetition);
  if (error != std::errc() || end != number.data() + number.size() ||
      key.repetition >= (std::uint64_t{1} << 40)) {
    return fail(Error{"", 0, "TRIAL",
                      "\"" + text + "\" names no trial, write CELL/REPETITION, for instance \"" +
                          spec.cells.front().name + "/3\""});
  }
  if (slash == std::string::npos) {
    if (spec.cells.size() == 1) return key;
    return fail(Error{"", 0, "TRIAL",
                      "\"" + text + "\" leaves the cell open, write CELL/REPETITION, for instance \"" +
                          spec.cells.front().name + "/" + number + "\""});
  }
  const Result<std::uint32_t> cell = find_cell(spec, text.substr(0, slash), "TRIAL");
  if (!cell) return fail(cell.error());
  key.cell = *cell;
  return key;
}

std::string trial_name(const CampaignSpec& spec, TrialKey key) {
  return spec.cells.at(key.cell).name + "/" + std::to_string(key.repetition);
}

}  // namespace fatmc::cli
