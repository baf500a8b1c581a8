// What a linear sampled model leaves of a record, bin by bin, with the record's own start and end taken into account.
//
//   x[n+1] = A x[n] + B u[n], y[n] = C x[n] + D u[n],   n = 0 ... N-1
//
// gives spectra (dft.h) that obey, exactly and for any A without a pole at a bin,
//
//   Y(m) = G U(m) + C (z I - A)^-1 z d / sqrt(N),   G = C (z I - A)^-1 B + D,  z = exp(2 pi i m / N),  d = x[0] - x[N]
//
// (sum x[n+1] z^-n over the record and eliminate; it is the extended transfer function model of T 2.3 for a state-space model). So
// an unstable model, which a simulation over the record would carry away, is compared like any other. d, one real number a
// state, is fitted by least squares to Y - G U over the bins given, each output weighed by what it leaves. Offsets of inputs and
// outputs stand at m = 0 alone, which is not among them.
#pragma once

#include <Eigen/Core>
#include <complex>
#include <vector>

#include "core/base/error.h"
#include "core/ident/matrix_stack.h"
#include "core/robust/nominal_model.h"

namespace fatmc {

struct LinearPrediction {
  MatrixStack<std::complex<double>> response;  ///< G, outputs x inputs, a bin each
  Eigen::MatrixXcd error;                      ///< bins x outputs: Y - G U less what d explains
  Eigen::VectorXd start;                       ///< d
};

/// `input`: bins x inputs, `output`: bins x outputs, of a record of `samples` samples at `rate_hz`; the bins lie at
/// `frequency_hz` > 0. Fails where a bin meets a pole on the unit circle, and where there are no more values than states.
Result<LinearPrediction> predict_linear(const SampledModel& model, double rate_hz, int samples,
                                        const std::vector<double>& frequency_hz,
                                        const Eigen::Ref<const Eigen::MatrixXcd>& input,
                                        const Eigen::Ref<const Eigen::MatrixXcd>& output);

}  // namespace fatmc
