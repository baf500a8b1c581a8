#include "campaigns/base/keep.h"

#include "campaigns/base/decoder.h"

namespace fatmc {

Result<Keep> decode_keep(const Tree& spec) {
  Keep keep;
  const Tree* tree = spec.find("keep");
  if (tree == nullptr) return keep;
  Decoder table(*tree, "keep");
  keep.arrays = table.boolean("arrays", true);
  const std::string records = table.choice("records", {"none", "failures", "all"}, "none");
  if (records == "failures") keep.records = Keep::Records::failures;
  if (records == "all") keep.records = Keep::Records::all;
  if (Status status = table.finish(); !status) return fail(status.error());
  return keep;
}

}  // namespace fatmc
