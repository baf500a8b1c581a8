// Where the error of a model is a response to the inputs that the model lacks, without any model of an effect.
//
// E = Y - Y_model are spectra of an output's error, U those of the inputs, in the band of interest. Neighbouring bins
// are cut into short windows, so that lightly damped modes are smooth within one;
//   E(m) = sum_j H_j(m) U_j(m) + T + V(m),   H_j polynomials of degree R in the frequency, T a constant, V white
// (T 2.99 and 2.123 with the inputs as regressors). With n = (R + 1) inputs + 1 unknowns and W bins, and element j not
// missing,
//   b = RSS / RSS_without ~ Beta(W - n, R + 1)     (complex Gaussian noise),
// so that -log b has the mean psi(W-n+R+1) - psi(W-n) and the variance psi'(W-n) - psi'(W-n+R+1). Its sum over the
// windows of a band follows nearly a gamma law; the band's sigma is the normal deviation with the same tail. Tests of all elements and bands together have one level
// (Bonferroni). What no input explains is incoherent: noise, nonlinearity, or inputs that were not recorded.
#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "core/base/error.h"

namespace fatmc {

struct ResidualOptions {
  int order = 1;               ///< R
  int spare = 5;               ///< complex degrees of freedom of a window's residual, W - n
  int bands = 12;              ///< of about equal numbers of windows
  double level = 0.01;         ///< of all tests together
  double window_level = 0.01;  ///< an element acts in those windows only in which it is significant by itself
  double material = 0.05;      ///< least share of an output's error that an element must explain
};

/// One element in one band.
struct ResidualPlace {
  int output = 0, input = 0;
  double low_hz = 0.0, high_hz = 0.0;
  double sigma = 0.0;  ///< normal deviation with the tail of the sum over windows
  double share = 0.0;  ///< of the output's error in the band that the element explains
};

struct ResidualResponse {
  std::vector<double> frequency_hz;  ///< of the bins
  Eigen::MatrixXcd
      response;  ///< bins x (outputs x inputs, column by column): H of the elements taken, else 0
  std::vector<std::pair<int, int>> elements;  ///< taken: output, input
  std::vector<double> explained;              ///< share of the output's error, an element each
  std::vector<ResidualPlace> places;          ///< bands beyond the limit
  double limit = 0.0;                         ///< of sigma, for all tests together
  Eigen::VectorXd before,
      after;              ///< of each output: sum of |E|^2 over the bins, and of what the elements leave
  Eigen::VectorXd floor;  ///< what no input explains
  Eigen::VectorXd output_energy;  ///< sum of |Y|^2
};

/// `error`, `output`: bins x outputs; `input`: bins x inputs; the bins ascend. Fails where they do not fill two
/// windows.
Result<ResidualResponse> fit_residual_response(const std::vector<double>& frequency_hz,
                                               const Eigen::Ref<const Eigen::MatrixXcd>& error,
                                               const Eigen::Ref<const Eigen::MatrixXcd>& output,
                                               const Eigen::Ref<const Eigen::MatrixXcd>& input,
                                               const ResidualOptions& options);

/// Error that is left of another record with the elements of a fit, interpolated in frequency: bins x outputs.
Eigen::MatrixXcd apply_residual_response(const ResidualResponse& fit, const std::vector<double>& frequency_hz,
                                         const Eigen::Ref<const Eigen::MatrixXcd>& error,
                                         const Eigen::Ref<const Eigen::MatrixXcd>& input);

}  // namespace fatmc
