// Is the true response inside the estimated confidence region? Counts over one trial, for every region that
// the study compares (T section 5.3).
//
// With e = Ĝ_ij − G0_ij, σ̂² = B_jj C_V,ii (complex variance, q degrees of freedom) and the interpolation bias
// b:
//   plain        |e|² / σ̂²                 T (5.13); F(2, 2q) for an unbiased Gaussian estimate
//   extended     max(0, |e| − b)² / σ̂²     the disc of radius b + r_p
//   as printed   (|e| − b)² / σ̂²           T (5.14); also rejects points nearer to the truth than b, so that
//   a good
//                                          estimate with a large b counts as an outlier
//   sample       |Ĝ − mean Ĝ|² n/(n−1) / σ̂²   error against the mean over the n trials, free of bias (5.3.3)
// All are compared with F⁻¹(p; 2, 2q).
#pragma once

#include <array>
#include <complex>
#include <cstddef>
#include <string_view>
#include <vector>

namespace fatmc::coverage {

enum class Region {
  plain,
  extended,                     ///< b with the constant of the actual line offsets
  extended_as_printed,          ///< the same b in (5.14)
  extended_printed_constant,    ///< b with the constant 0.0857 and (2 n_E + 1) Δf (2.145)
  printed_constant_as_printed,  ///< the same b in (5.14): the literal reading of print
  sample
};
inline constexpr std::array kRegions = {Region::plain,
                                        Region::extended,
                                        Region::extended_as_printed,
                                        Region::extended_printed_constant,
                                        Region::printed_constant_as_printed,
                                        Region::sample};
std::string_view region_name(Region region);
/// Print has a constant for the orders 2, 4 and 6 only.
bool needs_printed_constant(Region region);

inline constexpr std::array kLevels = {0.75, 0.90, 0.95, 0.99};

/// Estimates of one trial; vectors of lines × outputs × inputs elements, elements of a line side by side.
struct TrialErrors {
  std::vector<std::complex<double>> error;  ///< Ĝ − G0
  std::vector<std::complex<double>>
      sample_error;  ///< (Ĝ − mean Ĝ) √(n/(n−1)); empty while the mean is unknown
  std::vector<double> variance;
  std::vector<double> bias;          ///< constant of the actual offsets
  std::vector<double> bias_printed;  ///< printed constant; empty where print has none
};

/// |e| reduced as `region` says, squared, over the variance of element `index`.
double normalised_square(const TrialErrors& trial, Region region, std::size_t index);

/// Shares over the lines of one trial.
struct TrialCoverage {
  double element = 0.0;     ///< of elements inside their region of level p
  double joint = 0.0;       ///< of lines with all elements inside their regions of level p
  double bonferroni = 0.0;  ///< of lines with all elements inside regions of level 1 − (1 − p)/elements
};
TrialCoverage trial_coverage(const TrialErrors& trial, Region region, double level,
                             std::size_t elements_per_line, int degrees_of_freedom);

}  // namespace fatmc::coverage
