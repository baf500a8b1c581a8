// Where the error of a model is a response to the inputs that the model lacks, without any model of an effect.
//
// E = Y - Y_model are spectra of an output's error, U those of the inputs, in the band of interest. Neighbouring bins are cut
// into windows; within one,
//   E(m) = sum_j H_j(m) U_j(m) + T(m) + V(m),     H_j and the transient T polynomials of degree R in the frequency, V white
// (T 2.99 and 2.123 with the inputs as regressors). Element j is missing where its H_j lowers the residual more than chance does:
//   F = ((RSS_without - RSS)/(R + 1)) / (RSS/(W - n)) ~ F(2 (R + 1), 2 (W - n)),   n = (R + 1)(inputs + 1),
// complex degrees of freedom counting twice. Of all windows and elements the smallest p-value is multiplied by their number
// (Bonferroni). What no input explains is incoherent: noise, nonlinearity, or inputs that were not recorded.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/base/error.h"

namespace fatmc {

struct ResidualOptions {
  int window = 24;         ///< bins
  int order = 2;           ///< R
  double level = 0.01;     ///< of all tests together
  double material = 0.01;  ///< least share of an output's error that an element must explain
};

/// One element in one window.
struct ResidualPlace {
  int output = 0, input = 0;
  double low_hz = 0.0, high_hz = 0.0;
  double p = 1.0;      ///< of this window alone
  double share = 0.0;  ///< of the output's error in the window that the element explains
};

struct ResidualResponse {
  std::vector<double> frequency_hz;  ///< of the bins that windows cover
  Eigen::MatrixXcd response;         ///< bins x (outputs x inputs, column by column): H of the elements taken
  std::vector<std::pair<int, int>> elements;  ///< taken: output, input; by what they explain
  std::vector<double> explained;              ///< share of the output's error, an element each
  std::vector<ResidualPlace> places;          ///< windows with a p-value that holds for all tests together
  Eigen::VectorXd before, after,
      floor;  ///< of each output: error, error left, and what is incoherent, in |.|^2 over all bins
  Eigen::VectorXd output_energy;
  int tests = 0;
};

/// `error`, `output`: bins x outputs; `input`: bins x inputs; the bins ascend. Fails where they do not fill two windows or where a
/// window has fewer bins than unknowns.
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
