// How far the model is from a record by the measures of the field: cost function, MUAD, Theil's coefficient, index of
// agreement (core/accuracy).
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/discrepancy/model_simulator.h"
#include "core/ident/lpm_grid.h"

namespace fatmc {

/// What the model does on a record's reference, noise averaged out.
struct MeanFlight {
  Eigen::VectorXcd response;  ///< mean estimate of the frequency response matrix, order of response_vector
  Eigen::MatrixX3d output;    ///< mean of p, q, r, rad/s
};

/// Of flights `first` ... `first + count - 1`.
Result<MeanFlight> mean_flight(const ModelSimulator& model, const LpmGrid& grid,
                               const std::vector<Effect>& effects, int first, int count);

struct GapMeasures {
  double cost = 0.0;        ///< (3.8), mean over the diagonal elements
  double muad_share = 0.0;  ///< of lines of the diagonal elements outside the MUAD envelopes
  double theil = 0.0;       ///< of the outputs, mean of three
  double agreement = 0.0;   ///< d_1, geometric mean of three
};

/// `response` and `output` of the record against the model's. Elements without a magnitude are left out.
GapMeasures measure_gap(const std::vector<double>& frequency_hz,
                        const Eigen::Ref<const Eigen::VectorXcd>& response,
                        const Eigen::Ref<const Eigen::MatrixX3d>& output, const MeanFlight& model);

}  // namespace fatmc
