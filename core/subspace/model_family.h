// PBSIDopt models of many past windows, future windows and orders from one set of maneuvers, with all that
// they share computed once: one factorisation for the longest past and cheap steps to the shorter ones
// (nested_regression.h), one triangle a past for all futures (past_products.h), one subspace a future for all
// orders, warm-started from the future before (leading_subspace.h), one set of moments for A, B, C, K of all
// orders (state_moments.h). The models are those of identify_pbsid to rounding.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "core/base/error.h"
#include "core/subspace/maneuvers.h"
#include "core/subspace/pbsid_opt.h"

namespace fatmc {

struct FamilyPlan {
  std::vector<int> pasts;    ///< strictly descending
  std::vector<int> futures;  ///< strictly ascending; those beyond a past are left out there
  int lowest_order = 8, highest_order = 20;
  RegularizationOptions regularization;
  /// false: a rule chooses lambda at the first past, and it is kept for the others (no factorisation a past).
  bool lambda_for_each_past = true;
  FinalRegression final_regression = FinalRegression::paper;
};

struct FamilyMember {
  int past = 0, future = 0, order = 0;
};

/// Calls back for every model in the order of the plan: by past, future, order. A failure stands in the place
/// of its model; one of a past or future in the place of each of its models. Fails itself where the plan or
/// the longest past cannot be had.
Status identify_family(std::span<const Maneuver> maneuvers, const FamilyPlan& plan,
                       const std::function<void(const FamilyMember&, const Result<PbsidModel>&)>& visit);

}  // namespace fatmc
