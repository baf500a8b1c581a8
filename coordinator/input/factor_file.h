// Loops with uncertain plants as a CSV, a row a loop: what `fatmc ssv` reads.
//
//   id, Xre11, Xim11, Xre12, ..., w_out1_in1, w_out2_in1, ...
// Xre<r><c>, Xim<r><c>: element (r, c) of X = (I + K G)⁻¹ K, n_in × n_out (Xre<r>_<c> where an index has two digits);
// w_out<i>_in<j>: radius of G_ij. Sizes follow from the names; the order of the columns does not matter.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "core/base/error.h"

namespace fatmc {

struct LoopFactors {
  std::string id;
  Eigen::MatrixXcd x;     ///< n_in × n_out
  Eigen::MatrixXd radii;  ///< n_out × n_in
};

/// The error names the line and column of a name that is unknown, missing or twice there, of a row with too few or too
/// many values, and of a value that is not a finite number, or a negative radius.
Result<std::vector<LoopFactors>> read_loop_factors(const std::string& path);

}  // namespace fatmc
