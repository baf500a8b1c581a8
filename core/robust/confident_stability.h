// Confident stability level: how sure an estimated frequency response makes us that the loop is stable (T section 2.8).
//
// A line holds the estimate Ĝ (n_out × n_in), the standard deviation σ of each element (complex: σ² = E|Ĝ − G|²) from q
// degrees of freedom, and a bound b on what is systematic in it: interpolation bias plus intergrid error. With the radii
// W = b + σ (T 2.267) the loop tolerates κ W, κ = 1/H∞ or 1/ssv (T 2.254, 2.257), and the confidence of element ij is
// the level of its region b + r_p that has just that size (T 2.269-2.271):
//   κ (b + σ) = b + σ √F⁻¹(p; 2, 2q)   ⇒   p = F((κ (b + σ) − b)²/σ²; 2, 2q),  and p = 0 where κ (b + σ) ≤ b.
// In print the bare square makes p rise again for κ (b + σ) < b. F(x; 2, 2q) = 1 − (1 + x/q)^(−q); in print 2M − 2 = 2q.
//
// p is a level of one element; the plant has several, and Ĝ lies in the stable set if all are inside. Two rules:
//   min         min_ij p_ij: the level to which every single region may be drawn, the reading of (2.266) and (2.271).
//               It is not the probability that all regions hold: nine 95 % regions hold jointly 65 % if independent.
//   bonferroni  P(some element outside) ≤ Σ P(element outside), so max(0, 1 − Σ_ij (1 − p_ij)) bounds the joint
//               probability from below whatever the correlation; for equal p_ij it inverts the level 1 − (1 − p)/n.
// Elements known exactly (σ = b = 0) are always inside.
#pragma once

#include <Eigen/Core>
#include <complex>
#include <optional>
#include <span>
#include <string>

#include "core/robust/structured_singular_value.h"

namespace fatmc {

enum class CombinationRule { min, bonferroni };

struct StabilityOptions {
  CombinationRule combine = CombinationRule::min;  ///< as printed; Fig. 5-16 uses bonferroni
  bool bias = true;                                ///< count the interpolation bias
  double intergrid = 0.03;         ///< systematic error between lines as a share of |Ĝ_ij| (T section 5.5)
  double minimum_snr_db = 20.0;    ///< of every input, below it the estimate is not Gaussian (T section 2.6.2)
};

/// One line of an estimate. Shapes: response, sigma, bias n_out × n_in; bias may be empty (none).
struct EstimatedLine {
  Eigen::MatrixXcd response;
  Eigen::MatrixXd sigma;
  Eigen::MatrixXd bias;
  double degrees_of_freedom = 0.0;      ///< q > 0
  std::optional<double> input_snr_db;   ///< smallest over the inputs; absent: not judged
};

/// Systematic part of the uncertainty, b + intergrid |Ĝ|; n_out × n_in (T 2.267, section 2.8.4).
Eigen::MatrixXd systematic_error(const EstimatedLine& line, const StabilityOptions& options);

/// p of one element for a tolerated uncertainty κ (b + σ). κ ≥ 0, infinity allowed; σ, b ≥ 0; q > 0.
double element_confidence(double kappa, double sigma, double systematic, double q);

/// p of a line by the rule of the head of this file.
double line_confidence(double kappa, const Eigen::Ref<const Eigen::MatrixXd>& sigma,
                       const Eigen::Ref<const Eigen::MatrixXd>& systematic, double q, CombinationRule rule);

enum class JudgementStatus {
  ok,
  no_estimate,    ///< the estimator gave nothing on this line
  not_finite,     ///< estimate, deviation or model hold NaN or infinity: the estimator failed on this line
  wrong_shape,    ///< shapes do not fit each other, q ≤ 0, or a negative deviation
  singular_loop,  ///< I + K Ĝ or I + K G_n is singular: the loop is on the border of stability at this frequency
};
/// Reason and remedy in a few words.
std::string judgement_text(JudgementStatus status);

/// Judgement of one line. Where status is not ok the values are infinite, κ and p are zero: never NaN.
struct LineStability {
  JudgementStatus status = JudgementStatus::ok;
  double h_infinity_nominal = 0.0;  ///< of |Ĝ − G_n| around the nominal loop (T 2.259, 2.260); below 1: stable
  double ssv_nominal = 0.0;         ///< the same by the upper bound of ssv
  double h_infinity = 0.0;          ///< of W = b + σ around the estimated loop (T 2.252)
  SsvBounds ssv;                    ///< of W (T 2.255)
  double kappa_h_infinity = 0.0;
  double kappa_ssv = 0.0;           ///< from the upper bound: the safe side
  double p_h_infinity = 0.0;        ///< confidence in robust stability alone (T 2.271)
  double p_ssv = 0.0;
  bool snr_sufficient = true;
  double p_total_h_infinity = 0.0;  ///< zero unless κ_nom > 1 and the SNR suffices (T 2.272)
  double p_total_ssv = 0.0;
};

/// What a line that cannot be judged holds.
LineStability failed_line(JudgementStatus status);

/// Scalings of the two ssv problems of a line, handed from line to line or epoch to epoch: neighbours are close.
struct StabilityScalings {
  SsvScaling nominal;
  SsvScaling robust;
};

/// Judges one line. `nominal` is G_n (n_out × n_in), known to be stable under `controller` (n_in × n_out).
LineStability judge_line(const EstimatedLine& line, const Eigen::Ref<const Eigen::MatrixXcd>& nominal,
                         const Eigen::Ref<const Eigen::MatrixXcd>& controller, const StabilityOptions& options = {},
                         StabilityScalings* scalings = nullptr);

/// Over a band, lines taken as independent (T 2.273; neighbouring estimates are in fact correlated).
struct BandStability {
  bool nominally_stable_h_infinity = true;  ///< every line
  bool nominally_stable_ssv = true;
  double p_h_infinity = 1.0;        ///< product of p
  double p_ssv = 1.0;
  double p_total_h_infinity = 1.0;  ///< product of the gated p (T 2.272)
  double p_total_ssv = 1.0;
  int failed_lines = 0;             ///< status not ok
  int low_snr_lines = 0;
};
BandStability combine_lines(std::span<const LineStability> lines);

}  // namespace fatmc
