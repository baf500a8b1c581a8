// A MODEL of kind state_space, with the channels of a record picked by name:
//
//   kind = "state_space"
//   A, B, C, D     matrices, row by row; D absent: zero
//   time           "discrete" (default): x[n+1] = A x + B u, y = C x + D u, sampled at
//   rate_hz        or sample_time_s; must be the record's
//                  "continuous": dx/dt = A x + B u; sampled at the record's rate with held inputs
//   inputs         names of the columns of B; absent: the record's, in its order
//   outputs        names of the rows of C; likewise
#pragma once

#include <string>
#include <vector>

#include "campaigns/base/tree.h"
#include "core/base/error.h"
#include "core/record/record.h"
#include "core/robust/nominal_model.h"

namespace fatmc {

/// What a record is measured with, names in its order.
struct RecordChannels {
  std::vector<std::string> inputs, outputs;
  double rate_hz = 0.0;
  Hold hold = Hold::zoh;
};

/// A model with names, before the record's channels are picked.
struct NamedModel {
  SampledModel model;
  std::vector<std::string> inputs, outputs;
};

/// The error names file, line and key.
Result<NamedModel> decode_state_space(const Tree& tree, const RecordChannels& record);

/// Where each wanted name stands among those the model has; `role` is input or output.
Result<std::vector<Eigen::Index>> channel_places(const std::vector<std::string>& wanted,
                                                 const std::vector<std::string>& names,
                                                 const std::string& role, const std::string& path);

/// The record's inputs and outputs of the model, in the record's order.
Result<SampledModel> pick_channels(const NamedModel& named, const RecordChannels& record,
                                   const std::string& path);

}  // namespace fatmc
