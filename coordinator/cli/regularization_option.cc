#include "coordinator/cli/regularization_option.h"

#include <map>

#include "core/base/text.h"

namespace fatmc::cli {

Status read_regularization(const std::string& text, RegularizationOptions& options) {
  static const std::map<std::string, Regularization> kRules{
      {"gcv", Regularization::gcv}, {"srgcv", Regularization::srgcv}, {"lcurve", Regularization::lcurve}};
  if (const auto rule = kRules.find(text); rule != kRules.end()) {
    options.rule = rule->second;
    return {};
  }
  options.rule = Regularization::fixed;
  if (!parse_double(text, options.lambda) || options.lambda < 0.0) {
    return fail(Error{"", 0, "--regularization",
                      "\"" + text + "\" is neither gcv, srgcv, lcurve nor a lambda of 0 or more"});
  }
  return {};
}

}  // namespace fatmc::cli
