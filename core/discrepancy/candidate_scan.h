// Which effects, at which size, could explain what is left of a discrepancy: no flight is needed.
//
// For a white residual r and directions J that are fitted already, a candidate that changes the features by m gains
//   2 m_J^T r - m_J^T m_J,   m_J the part of m orthogonal to J,
// in |r|^2. A candidate of one parameter is followed along its curve (effect_curve.h), one of several over the signatures of the
// dictionary and the grid of modes (resonance.h), scaled.
#pragma once

#include <vector>

#include "core/discrepancy/comparison.h"

namespace fatmc {

struct Candidate {
  int variant = -1;
  Effect effect;  ///< at the values that gain most
  double gain = 0.0;
};

/// The best values of every candidate that gains anything, the best candidate first. `deviation`: as in effect_fit.h, or empty.
std::vector<Candidate> scan_candidates(const Comparison& comparison,
                                       const Eigen::Ref<const Eigen::VectorXd>& residual,
                                       const Eigen::Ref<const Eigen::MatrixXd>& jacobian,
                                       const Eigen::Ref<const Eigen::VectorXd>& deviation);

}  // namespace fatmc
