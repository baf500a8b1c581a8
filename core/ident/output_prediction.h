// What an estimated response makes of a record's inputs, beside what was measured.
//
//   Y^(k) = G(f_k) U(k)  over the DFT bins of the whole record between the response's first and last line
//   VAF   = 1 - sum_k |Y - Y^|^2 / sum_k |Y|^2   (variance accounted for, by Parseval that of the band-passed
//   signals)
//
// Between its lines G is interpolated linearly, real and imaginary part; a record of the estimate's own
// length has its bins on the lines. Circular convolution: the record starts and ends at rest, or repeats.
#pragma once

#include <Eigen/Core>
#include <complex>
#include <vector>

#include "core/base/error.h"
#include "core/ident/matrix_stack.h"

namespace fatmc {

struct OutputPrediction {
  int first_bin = 0, last_bin = 0;
  Eigen::MatrixXd measured;   ///< samples x n_out, restricted to the bins
  Eigen::MatrixXd predicted;  ///< samples x n_out
  Eigen::VectorXd vaf;        ///< n_out; at most 1, negative where the prediction is worse than none
  Eigen::VectorXd
      band_share;  ///< n_out: share of the measured output's variance (mean left out) inside the bins
};

/// `frequency_hz` ascending, `response` n_out x n_in at each; `outputs` samples x n_out, `inputs` samples x
/// n_in. Fails where no bin of the record lies between the lines, or an output is nothing there.
Result<OutputPrediction> predict_outputs(const std::vector<double>& frequency_hz,
                                         const MatrixStack<std::complex<double>>& response,
                                         const Eigen::Ref<const Eigen::MatrixXd>& outputs,
                                         const Eigen::Ref<const Eigen::MatrixXd>& inputs, double rate_hz);

}  // namespace fatmc
