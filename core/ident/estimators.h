// All estimators behind one call: measurements and a method in, a response with its covariance out.
//
// | method    | records | excitation            | smooths over    | law of |G - G0|^2 / variance            |
// | lpm       | 1       | periodic              | lines           | F(2, 2q)                                 |
// | tlpm      | 1, n_in | periodic              | -               | F(2, 2q), q = P - 1 for P >= 5           |
// | etfe      | 1, n_in | periodic, steady      | -               | F(2, 2q), q = P - 1                      |
// | robust    | > n_in  | periodic              | -               | F(2, 2q), q = records - n_in             |
// | arbitrary | 1       | any                   | bins            | F(2, 2q)                                 |
// |           | > n_in  | any, from rest        | bins, guarded   | F(2, 2q), joint_records.h                |
// | lrm       | 1       | any                   | lines or bins   | none                                     |
// | welch     | 1       | any                   | segments        | F(2, 2q) for independent segments        |
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "core/base/error.h"
#include "core/ident/measurement.h"
#include "core/ident/welch.h"

namespace fatmc {

enum class EstimationMethod { lpm, tlpm, etfe, lrm, arbitrary, robust, welch };

std::optional<EstimationMethod> estimation_method(std::string_view name);
std::string_view name_of(EstimationMethod method);
/// "lpm, tlpm, ..."
std::string estimation_method_names();
/// A period and its lines must be known (else an aperiodic record will do).
bool needs_period(EstimationMethod method);

struct EstimatorOptions {
  /// Lines or bins on each side. Without: 9 (lpm, arbitrary: q of 10 and 7 for three inputs), 6 (lrm: more would reach
  /// beyond a lightly damped mode). At least as many as leave a degree of freedom.
  std::optional<int> n_e;
  int order = 2;                   ///< odd orders gain nothing in a symmetric window, 4 needs twice the lines
  std::optional<int> n_transient;  ///< without: 5, or for tlpm with 5 periods and more as many as give q = P - 1
  WelchOptions welch;
  int threads = 1;  ///< for lrm, whose lines are costly; the result does not depend on it

  /// What a method takes for options that are left open.
  [[nodiscard]] int n_e_of(EstimationMethod method) const;
};

/// The error names the option or the property of the records that has to change.
Result<ResponseEstimate> estimate_response(EstimationMethod method, std::span<const Measurement> measurements,
                                           const EstimatorOptions& options);

}  // namespace fatmc
