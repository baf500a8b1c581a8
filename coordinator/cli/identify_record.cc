#include "coordinator/cli/identify_record.h"

#include <utility>

namespace fatmc::cli {

Result<IdentifiedRecords> identify_records(const IdentifyArguments& arguments) {
  const auto maneuvers = read_maneuvers(arguments);
  if (!maneuvers) return fail(maneuvers.error());
  const std::vector<Maneuver> data = maneuvers->data();
  IdentifiedRecords out;
  for (const Maneuver& maneuver : data) out.samples += maneuver.samples();
  out.inputs = maneuvers->inputs;
  out.outputs = maneuvers->outputs;
  out.rate_hz = maneuvers->rate_hz;
  auto model = identify_pbsid(data, arguments.pbsid);
  if (!model) return fail(Error{arguments.records.front(), 0, "identify", model.error().message});
  out.model = std::move(*model);
  const DiscreteModel discrete{out.model.a, out.model.b, out.model.c};
  auto continuous = continuous_model(discrete, 1.0 / out.rate_hz, arguments.continuation);
  if (continuous) {
    out.continuous = std::move(*continuous);
  } else {
    out.continuous_failure = continuous.error().message;
  }
  for (const NamedManeuver& maneuver : maneuvers->identification) {
    out.identification.push_back(score(maneuver, out.outputs, discrete, arguments.weights));
  }
  for (const NamedManeuver& maneuver : maneuvers->validation) {
    out.validation.push_back(score(maneuver, out.outputs, discrete, arguments.weights));
  }
  return out;
}

}  // namespace fatmc::cli
