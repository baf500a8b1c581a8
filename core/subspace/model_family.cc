#include "core/subspace/model_family.h"

#include <algorithm>
#include <string>
#include <utility>

#include "core/subspace/leading_subspace.h"
#include "core/subspace/nested_regression.h"
#include "core/subspace/past_products.h"
#include "core/subspace/state_moments.h"

namespace fatmc {
namespace {

using Visit = std::function<void(const FamilyMember&, const Result<PbsidModel>&)>;

Status check_plan(const FamilyPlan& plan) {
  if (plan.pasts.empty() || plan.futures.empty()) return fail("no past or no future window was given");
  if (std::adjacent_find(plan.pasts.begin(), plan.pasts.end(), std::less_equal<>()) != plan.pasts.end())
    return fail("past windows have to descend");
  if (std::adjacent_find(plan.futures.begin(), plan.futures.end(), std::greater_equal<>()) !=
      plan.futures.end())
    return fail("future windows have to ascend");
  if (plan.pasts.back() < 1 || plan.futures.front() < 1) return fail("windows are at least 1");
  if (plan.lowest_order < 1 || plan.lowest_order > plan.highest_order)
    return fail("the orders are empty or below 1");
  return {};
}

void visit_failure(const FamilyPlan& plan, int past, int future, const Error& error, const Visit& visit) {
  for (int order = plan.lowest_order; order <= plan.highest_order; ++order)
    visit({past, future, order}, fail(error));
}

void visit_past(const FamilyPlan& plan, const PastProducts& products, double lambda, const Visit& visit) {
  LeadingTriplets start;
  for (const int future : plan.futures) {
    if (future > products.past) break;
    const Eigen::Index size = static_cast<Eigen::Index>(future) * products.n_y;
    const int states = static_cast<int>(std::min<Eigen::Index>(plan.highest_order, size));
    auto leading = leading_triplets(products.triangle.topLeftCorner(size, size), states, start);
    if (!leading) {
      visit_failure(plan, products.past, future, leading.error(), visit);
      continue;
    }
    const StateMoments moments = state_moments(products, *leading, future, states);
    for (int order = plan.lowest_order; order <= plan.highest_order; ++order) {
      Result<PbsidModel> model = moment_model(moments, order, plan.final_regression);
      if (model) model->lambda = lambda;
      visit({products.past, future, order}, model);
    }
    start = std::move(*leading);
  }
}

}  // namespace

Status identify_family(std::span<const Maneuver> maneuvers, const FamilyPlan& plan, const Visit& visit) {
  if (Status status = check_plan(plan); !status) return status;
  auto regression = NestedRegression::make(maneuvers, plan.pasts.front());
  if (!regression) return fail(regression.error());
  RegularizationOptions regularization = plan.regularization;
  for (const int past : plan.pasts) {
    regression->shorten(past);
    const auto solution = regression->solve(regularization);
    if (!solution) {
      for (const int future : plan.futures) {
        if (future <= past) visit_failure(plan, past, future, solution.error(), visit);
      }
      continue;
    }
    if (!plan.lambda_for_each_past) regularization = {Regularization::fixed, solution->lambda};
    visit_past(plan, past_products(*regression, maneuvers, solution->xi), solution->lambda, visit);
  }
  return {};
}

}  // namespace fatmc
