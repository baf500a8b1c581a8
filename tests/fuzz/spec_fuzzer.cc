// Specs: a campaign that decodes has cells with names, an identity and seeds for its trials.
#include <cstdint>

#include "campaigns/base/campaign_spec.h"
#include "coordinator/input/toml_file.h"
#include "proto/wire.h"
#include "tests/fuzz/input_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace fatmc;
  static InputFile file;
  file.fill({reinterpret_cast<const char*>(data), size});
  const Result<Tree> tree = read_toml(file.path());
  if (!tree) {
    check_error(tree.error().text());
    return 0;
  }
  const Result<CampaignSpec> spec = decode_campaign(*tree);
  if (!spec) {
    check_error(spec.error().text());
    return 0;
  }
  if (spec->cells.empty() || spec->identity().size() != 64) std::abort();
  for (const Cell& cell : spec->cells)
    if (cell.name.empty()) std::abort();
  // What a worker is told is what the coordinator read.
  const Result<Message> sent = decode(encode(Welcome{spec->identity(), spec->tree, 500}));
  if (sent && !(std::get<Welcome>(*sent).spec == spec->tree)) {
    if (canonical_text(std::get<Welcome>(*sent).spec) != canonical_text(spec->tree))
      std::abort();  // NaN apart
  }
  return 0;
}
