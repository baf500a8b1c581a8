// The shared computation against the direct one of core/subspace, model by model.
#include "core/subspace/model_family.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "core/random/random_stream.h"
#include "core/subspace/leading_subspace.h"
#include "core/subspace/nested_regression.h"
#include "core/subspace/predictor_regression.h"
#include "core/subspace/state_sequence.h"
#include "tests/unit/subspace/vector_arx.h"

namespace fatmc {
namespace {

/// Three outputs, two inputs; modes of different speed, outputs of different size.
std::vector<Eigen::MatrixXd> coupled_system() {
  Eigen::MatrixXd one(3, 5), two(3, 5), three(3, 5);
  one << 0.5, 0.1, 1.6, 0.1, 0.0,  //
      0.0, 0.4, 0.1, 1.1, 0.05,    //
      0.2, 0.3, 0.0, 0.1, 0.8;
  two << 0.3, 0.0, -0.68, 0.0, 0.05,  //
      0.1, -0.2, 0.0, -0.5, 0.0,      //
      0.0, 0.1, 0.05, 0.0, -0.3;
  three << 0.1, 0.0, 0.02, 0.0, 0.0,  //
      0.0, 0.1, 0.0, 0.1, 0.0,        //
      0.0, 0.0, 0.0, 0.05, 0.1;
  return {one, two, three};
}

std::vector<Maneuver> maneuvers(Eigen::Index samples, double feedback, std::uint64_t run) {
  std::vector<Maneuver> out;
  for (const std::uint64_t part : {0, 1, 2})
    out.push_back(vector_arx(coupled_system(), 2, samples + 17 * static_cast<Eigen::Index>(part), 0.3,
                             feedback, run + part));
  return out;
}

/// Largest distance from an eigenvalue of one list to the nearest one of the other.
double distance(const Eigen::VectorXcd& one, const Eigen::VectorXcd& other) {
  double worst = 0.0;
  for (const std::complex<double>& z : one) worst = std::max(worst, (other.array() - z).abs().minCoeff());
  return worst;
}

using Key = std::tuple<int, int, int>;

struct Family {
  std::map<Key, PbsidModel> models;
  std::map<Key, std::string> failures;
};

Family family_of(const std::vector<Maneuver>& data, const FamilyPlan& plan) {
  Family out;
  const Status status =
      identify_family(data, plan, [&](const FamilyMember& member, const Result<PbsidModel>& model) {
        const Key key{member.past, member.future, member.order};
        if (model) {
          out.models.emplace(key, *model);
        } else {
          out.failures.emplace(key, model.error().message);
        }
      });
  EXPECT_TRUE(status.has_value());
  return out;
}

PbsidOptions direct_options(const FamilyPlan& plan, const Key& key) {
  return {std::get<0>(key), std::get<1>(key), std::get<2>(key), plan.regularization, plan.final_regression};
}

void expect_same(const PbsidModel& shared, const PbsidModel& direct, const std::string& what) {
  EXPECT_LT(std::abs(shared.lambda - direct.lambda), 1e-9 * std::max(direct.lambda, 1e-300)) << what;
  const Eigen::Index common = std::min(shared.singular_values.size(), direct.singular_values.size());
  const Eigen::VectorXd differences =
      shared.singular_values.head(common) - direct.singular_values.head(common);
  EXPECT_LT(differences.cwiseAbs().maxCoeff(), 1e-10 * direct.singular_values(0)) << what;
  EXPECT_LT(distance(shared.eigenvalues, direct.eigenvalues), 1e-9) << what;
  EXPECT_LT(distance(direct.eigenvalues, shared.eigenvalues), 1e-9) << what;
  // What does not depend on the signs of the states: Markov parameters of input and innovation, covariance.
  const double scale = (direct.c * direct.b).norm() + (direct.c * direct.k).norm();
  EXPECT_LT((shared.c * shared.a * shared.b - direct.c * direct.a * direct.b).norm(), 1e-9 * scale) << what;
  EXPECT_LT((shared.c * shared.k - direct.c * direct.k).norm(), 1e-8 * scale) << what;
  EXPECT_LT((shared.innovation - direct.innovation).norm(), 1e-9 * direct.innovation.norm()) << what;
  EXPECT_NEAR(shared.predictor_radius, direct.predictor_radius, 1e-8) << what;
}

FamilyPlan small_plan() {
  FamilyPlan plan;
  for (int past = 26; past >= 6; past -= 2) plan.pasts.push_back(past);
  for (int future = 4; future <= 26; future += 2) plan.futures.push_back(future);
  plan.lowest_order = 2;
  plan.highest_order = 9;
  plan.regularization = {Regularization::fixed, 2.0};
  return plan;
}

std::string text(const Key& key) {
  return "p " + std::to_string(std::get<0>(key)) + ", f " + std::to_string(std::get<1>(key)) + ", n " +
         std::to_string(std::get<2>(key));
}

/// `count` of the models, at random, against the direct computation.
void compare_some(const std::vector<Maneuver>& data, const FamilyPlan& plan, int count, std::uint64_t run) {
  const Family family = family_of(data, plan);
  EXPECT_TRUE(family.failures.empty()) << family.failures.begin()->second;
  RandomStream stream({run, 0, 0, 0}, "choice");
  for (int i = 0; i < count; ++i) {
    auto chosen = family.models.begin();
    std::advance(chosen, static_cast<long>(stream.uniform() * static_cast<double>(family.models.size())));
    const auto direct = identify_pbsid(data, direct_options(plan, chosen->first));
    ASSERT_TRUE(direct.has_value()) << direct.error().message;
    expect_same(chosen->second, *direct, text(chosen->first));
  }
}

TEST(ModelFamily, FiftyRandomModelsAreThoseOfTheDirectComputation) {
  compare_some(maneuvers(300, 0.0, 1), small_plan(), 50, 1);
}

TEST(ModelFamily, ModelsOfAClosedLoopWithTheResidualRegressionToo) {
  FamilyPlan plan = small_plan();
  plan.final_regression = FinalRegression::residual;
  compare_some(maneuvers(300, 0.2, 5), plan, 10, 2);
}

TEST(ModelFamily, WithoutRegularizationAndWithEachRule) {
  FamilyPlan plan = small_plan();
  plan.pasts = {20, 12};
  plan.regularization = {Regularization::fixed, 0.0};
  compare_some(maneuvers(200, 0.0, 9), plan, 6, 3);
  // Not the corner of the L-curve: these data are well conditioned, their curve is flat to rounding.
  for (const Regularization rule : {Regularization::gcv, Regularization::srgcv}) {
    SCOPED_TRACE(static_cast<int>(rule));
    plan.regularization = {rule, 0.0};
    compare_some(maneuvers(200, 0.0, 9), plan, 4, 4);
  }
}

TEST(ModelFamily, LongFuturesGoThroughTheIteration) {
  FamilyPlan plan = small_plan();
  plan.pasts = {120, 112};
  plan.futures = {20, 108, 110, 112};  // 324 rows and more: beyond the size of a full decomposition
  compare_some(maneuvers(500, 0.0, 13), plan, 5, 5);
}

TEST(ModelFamily, LambdaMayBeKeptFromTheLongestPast) {
  FamilyPlan plan = small_plan();
  plan.pasts = {20, 12};
  plan.regularization = {Regularization::srgcv, 0.0};
  plan.lambda_for_each_past = false;
  const std::vector<Maneuver> data = maneuvers(200, 0.0, 9);
  const Family family = family_of(data, plan);
  const double lambda = family.models.at({20, 8, 4}).lambda;
  EXPECT_GT(lambda, 0.0);
  plan.regularization = {Regularization::fixed, lambda};
  const Key key{12, 8, 4};
  const auto direct = identify_pbsid(data, direct_options(plan, key));
  ASSERT_TRUE(direct.has_value());
  expect_same(family.models.at(key), *direct, text(key));
}

TEST(ModelFamily, AModelDoesNotDependOnWhichOthersAreComputedWithIt) {
  const std::vector<Maneuver> data = maneuvers(200, 0.0, 17);
  FamilyPlan alone = small_plan();
  alone.pasts = {10};
  alone.futures = {6};
  const Family family = family_of(data, small_plan()), one = family_of(data, alone);
  const Key key{10, 6, 5};
  expect_same(family.models.at(key), one.models.at(key), "alone");
}

TEST(ModelFamily, AnOrderThatAFutureCannotCarryIsAFailureInItsPlaceAndTheOthersGoOn) {
  FamilyPlan plan = small_plan();
  plan.pasts = {12};
  plan.futures = {2, 6};
  const Family family = family_of(maneuvers(200, 0.0, 17), plan);
  EXPECT_EQ(family.failures.size(), 3U);  // orders 7, 8 and 9 of f = 2, which has six rows
  EXPECT_NE(family.failures.at({12, 2, 7}).find("lengthen the future"), std::string::npos);
  EXPECT_EQ(family.models.size(), 13U);
}

TEST(ModelFamily, PlansThatMakeNoSenseAreRefused) {
  const std::vector<Maneuver> data = maneuvers(100, 0.0, 21);
  const auto ignore = [](const FamilyMember&, const Result<PbsidModel>&) {};
  FamilyPlan plan = small_plan();
  plan.pasts = {10, 12};
  EXPECT_NE(identify_family(data, plan, ignore).error().message.find("descend"), std::string::npos);
  plan.pasts = {60};  // more unknowns than equations
  EXPECT_NE(identify_family(data, plan, ignore).error().message.find("the largest for these maneuvers is"),
            std::string::npos);
}

TEST(NestedRegression, EachShorterWindowHasTheFactorOfItsOwnData) {
  const std::vector<Maneuver> data = maneuvers(150, 0.1, 25);
  auto nested = NestedRegression::make(data, 20);
  ASSERT_TRUE(nested.has_value());
  for (const int past : {20, 13, 12, 3}) {
    nested->shorten(past);
    const auto direct = factor_predictor(data, past);
    ASSERT_TRUE(direct.has_value());
    const Eigen::MatrixXd gram = direct->r.transpose() * direct->r;
    const Eigen::MatrixXd r = nested->r().triangularView<Eigen::Upper>();
    EXPECT_LT((r.transpose() * r - gram).norm(), 1e-13 * gram.norm());
    EXPECT_EQ(nested->equations(), direct->equations);
    for (const double lambda : {0.0, 1.0}) {
      const auto one = nested->solve({Regularization::fixed, lambda});
      const auto other = solve_predictor(*direct, {Regularization::fixed, lambda});
      ASSERT_TRUE(one.has_value() && other.has_value());
      EXPECT_LT((one->xi - other->xi).norm(), 1e-11 * other->xi.norm());
    }
  }
}

/// Upper triangular with a slowly falling spectrum.
Eigen::MatrixXd slow_triangle(Eigen::Index size, double decay) {
  RandomStream stream({3, 0, 0, 0}, "triangle");
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(size, size);
  for (Eigen::Index j = 0; j < size; ++j) {
    for (Eigen::Index i = 0; i <= j; ++i)
      out(i, j) = stream.normal() * std::pow(decay, static_cast<double>(i + j));
  }
  return out;
}

TEST(LeadingSubspace, IterationAgreesWithTheFullDecomposition) {
  for (const double decay : {0.95, 0.99, 0.999}) {
    const Eigen::MatrixXd triangle = slow_triangle(400, decay);
    LeadingOptions full;
    full.dense_size = 1000;
    const auto iterated = leading_triplets(triangle, 12),
               decomposed = leading_triplets(triangle, 12, {}, full);
    ASSERT_TRUE(iterated.has_value() && decomposed.has_value()) << iterated.error().message;
    EXPECT_GT(iterated->rounds, 0);
    EXPECT_EQ(decomposed->rounds, 0);
    EXPECT_LT((iterated->s.head(12) - decomposed->s.head(12)).norm(), 1e-12 * decomposed->s(0));
    for (Eigen::Index i = 0; i < 12; ++i)
      EXPECT_NEAR(std::abs(iterated->u.col(i).dot(decomposed->u.col(i))), 1.0, 1e-10) << decay << " " << i;
  }
}

TEST(LeadingSubspace, AStartFromTheLeadingBlockSavesRestartsAndChangesNothing) {
  const Eigen::MatrixXd triangle = slow_triangle(400, 0.99);
  const auto smaller = leading_triplets(triangle.topLeftCorner(390, 390), 10);
  ASSERT_TRUE(smaller.has_value());
  const auto cold = leading_triplets(triangle, 10), warm = leading_triplets(triangle, 10, *smaller);
  ASSERT_TRUE(cold.has_value() && warm.has_value());
  EXPECT_LE(warm->rounds, cold->rounds);
  EXPECT_LT((warm->s.head(10) - cold->s.head(10)).norm(), 1e-13 * cold->s(0));
}

TEST(LeadingSubspace, AChainOfGrowingBlocksDoesNotDrift) {
  const Eigen::MatrixXd triangle = slow_triangle(520, 0.998);
  LeadingTriplets chained;
  for (Eigen::Index size = 330; size <= 520; size += 10)
    chained = *leading_triplets(triangle.topLeftCorner(size, size), 12, chained);
  LeadingOptions full;
  full.dense_size = 1000;
  const auto decomposed = leading_triplets(triangle, 12, {}, full);
  ASSERT_TRUE(decomposed.has_value());
  EXPECT_GT(chained.rounds, 0);
  EXPECT_LT((chained.s.head(12) - decomposed->s.head(12)).norm(), 1e-13 * decomposed->s(0));
  const Eigen::MatrixXd u = chained.u.leftCols(12), w = chained.w.leftCols(12);
  const Eigen::MatrixXd full_triangle = triangle.triangularView<Eigen::Upper>();
  EXPECT_LT((full_triangle * u - w * chained.s.head(12).asDiagonal()).norm(), 1e-13 * chained.s(0));
}

TEST(LeadingSubspace, SmallSingularValuesKeepTheirDigits) {
  // A diagonal matrix: its values are known. A Gram matrix would lose all below 1e-8 of the largest.
  Eigen::MatrixXd diagonal = Eigen::MatrixXd::Zero(400, 400);
  for (Eigen::Index i = 0; i < 400; ++i) diagonal(i, i) = std::pow(10.0, -static_cast<double>(i) / 2.0);
  const auto leading = leading_triplets(diagonal, 20);
  ASSERT_TRUE(leading.has_value()) << leading.error().message;
  for (Eigen::Index i = 0; i < 20; ++i)
    EXPECT_NEAR(leading->s(i), std::pow(10.0, -static_cast<double>(i) / 2.0), 1e-15);
}

}  // namespace
}  // namespace fatmc
