// What a diagnosis does beyond a scan and a fit: dependence on level, pairs, derivatives that are off, turbulence that no one states.
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>

#include "core/discrepancy/derivative_tolerance.h"
#include "core/discrepancy/level_probe.h"
#include "core/discrepancy/pair_scan.h"
#include "tests/unit/discrepancy/diagnosis_bench.h"

namespace fatmc {
namespace {

using BeyondTheScan = DiagnosisOfARecord;

TEST_F(BeyondTheScan, HigherMomentsShowOnHarmonicsThatAreNotExcitedAndLinearDerivativesDoNot) {
  const FeatureLayout& layout = bench_->layout;
  const FeatureBlock& block = layout.blocks[layout.blocks.size() - 1];
  ASSERT_EQ(block.kind, FeatureKind::moment);
  ASSERT_EQ(block.size(), 6);
  // White by the law, flights that neither it nor the filters have seen.
  const auto outputs = [&](const char* effect, int first, int count) {
    std::vector<std::vector<Effect>> sets(1);
    if (effect != nullptr) sets.front().push_back(*parse_effect(effect));
    const Eigen::MatrixXd x = bench_->model.fly(sets, first, count, 2).front().features;
    return Eigen::MatrixXd(bench_->basis->law.whiten(layout, x.colwise() - bench_->basis->law.mean)
                               .middleRows(block.first, block.size()));
  };
  const Eigen::MatrixXd plain = outputs(nullptr, 400, 60);
  const Eigen::VectorXd variance = plain.rowwise().squaredNorm() / 60.0;
  // Four standard errors of a variance over 60 flights, by a law from 300.
  for (Eigen::Index i = 0; i < 6; ++i)
    EXPECT_NEAR(variance[i], 1.0, 4.0 * std::sqrt(2.0 / 60.0 + 2.0 / 300.0)) << i;
  // With the same noise: the moment of roll moves its own filter, a derivative of roll that changes the response more does not.
  const Eigen::VectorXd base = plain.leftCols(2).rowwise().mean();
  const Eigen::VectorXd moment =
      outputs("quadratic_damping:axis=roll,ratio=2", 400, 2).rowwise().mean() - base;
  const Eigen::VectorXd linear = outputs("cl_p:factor=1.4", 400, 2).rowwise().mean() - base;
  EXPECT_GT(moment[0], 3.0);
  EXPECT_LT(linear.cwiseAbs().maxCoeff(), 1.0);
}

TEST_F(BeyondTheScan, IsUnknownWhereAValueDependsOnLevelAndNamedWhereItDoesNot) {
  const Diagnosis grows =
      bench_->answer(bench_->record({*parse_effect("quadratic_damping:axis=roll,ratio=2")}, 11));
  EXPECT_EQ(grows.verdict, Verdict::unknown);
  EXPECT_GT(std::abs(grows.evidence.level), grows.evidence.level_limit);
  ASSERT_FALSE(grows.notes.empty());
  EXPECT_NE(grows.notes.front().find("depends on level"), std::string::npos) << grows.notes.front();
  const Diagnosis constant = bench_->answer(bench_->record({*parse_effect("cl_p:factor=1.3")}, 12));
  EXPECT_EQ(constant.verdict, Verdict::named);
  EXPECT_LT(std::abs(constant.evidence.level), constant.evidence.level_limit);
}

TEST_F(BeyondTheScan, APairThatMakesTheDiscrepancyIsFoundAmongAllPairs) {
  const Comparison comparison({{&bench_->model, bench_->basis.get(), bench_->record({}, 13)}}, 2);
  const auto curve_of = [&](const char* name) {
    for (const EffectCurve& curve : comparison.curves()) {
      if (comparison.dictionary().variants[static_cast<std::size_t>(curve.variant())].name() == name)
        return curve;
    }
    return comparison.curves().front();
  };
  const EffectCurve a = curve_of("control_effectiveness:axis=pitch"), b = curve_of("cm_alpha");
  const double t = std::log(1.19), u = std::log(1.33);
  const Eigen::VectorXd z = comparison.atoms()(Eigen::all, a.atoms()) * a.shares(t) +
                            comparison.atoms()(Eigen::all, b.atoms()) * b.shares(u);
  const std::vector<CandidatePair> pairs = scan_pairs(comparison, z, {}, 3);
  ASSERT_FALSE(pairs.empty());
  EXPECT_NEAR(pairs.front().gain, z.squaredNorm(), 0.1);
  for (const Effect& effect : pairs.front().effects) {
    EXPECT_TRUE(effect.name() == "control_effectiveness:axis=pitch" || effect.name() == "cm_alpha")
        << effect.text();
    EXPECT_NEAR(effect.values.front(), effect.id == "cm_alpha" ? 1.33 : 1.19, 0.01);
  }
}

TEST_F(BeyondTheScan, TolerableErrorsOfDerivativesMinimiseTheirPenalisedResidual) {
  const Comparison comparison({{&bench_->model, bench_->basis.get(), bench_->record({}, 14)}}, 2);
  const DerivativeTolerance tolerance(comparison, {"cn_p"});
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(comparison.size());
  const Eigen::MatrixXd j = comparison.atoms().leftCols(1);
  const auto with = [&](const Eigen::VectorXd& r) { return tolerance.errors({}, r, j, ones); };
  const Eigen::VectorXd r =
      comparison.discrepancy() - j * (j.transpose() * comparison.discrepancy()) / j.squaredNorm();
  const DerivativeTolerance::Errors errors = with(r);
  const auto count = errors.log_factor.size();
  ASSERT_GT(count, 6);
  for (const Effect& e : errors.derivatives) EXPECT_NE(e.id, "cn_p") << "is no candidate of this search";
  // The minimum of |r - J x - D t|^2 + |t|^2 over x and t, stacked; D from what unit errors explain of themselves.
  Eigen::MatrixXd stacked = Eigen::MatrixXd::Zero(comparison.size() + count, 1 + count);
  stacked.topLeftCorner(comparison.size(), 1) = j;
  for (Eigen::Index i = 0; i < count; ++i) {
    const Effect& derivative = errors.derivatives[static_cast<std::size_t>(i)];
    double least = 1e300;
    for (std::size_t a = 0; a < comparison.dictionary().atoms.size(); ++a) {
      const Effect& atom = comparison.dictionary().atoms[a].effect;
      const double size = std::log(atom.values.front());
      if (atom.name() != derivative.name() || std::abs(size) >= least) continue;
      least = std::abs(size);
      stacked.col(1 + i).head(comparison.size()) =
          DerivativeTolerance::kShare / size * comparison.atoms().col(static_cast<Eigen::Index>(a));
    }
    stacked(comparison.size() + i, 1 + i) = 1.0;
  }
  Eigen::VectorXd right = Eigen::VectorXd::Zero(comparison.size() + count);
  right.head(comparison.size()) = r;
  const Eigen::VectorXd solved = (stacked.transpose() * stacked).ldlt().solve(stacked.transpose() * right);
  EXPECT_NEAR(errors.energy, (right - stacked * solved).squaredNorm(), 1e-6 * errors.energy);
  EXPECT_LT((errors.log_factor / DerivativeTolerance::kShare - solved.tail(count)).norm(), 1e-6);
  EXPECT_NEAR(errors.shift[0], solved[0], 1e-6);
}

TEST_F(BeyondTheScan, TurbulenceThatNoOneStatesIsEstimatedAndNotNamed) {
  const Eigen::VectorXd features = bench_->record(
      {*parse_effect("gyro_scale:axis=roll,error=0.12"), *parse_effect("turbulence:factor=1.5")}, 15);
  DiagnosisOptions options;
  options.excluded = {"turbulence"};
  options.nuisances = {*nominal_effect("turbulence", {})};
  const Diagnosis d =
      diagnose(Comparison({{&bench_->model, bench_->basis.get(), features}}, 2), nullptr, options);
  ASSERT_EQ(d.verdict, Verdict::named);
  ASSERT_EQ(d.effects.size(), 1u);
  EXPECT_EQ(d.effects.front().effect.name(), "gyro_scale:axis=roll");
  ASSERT_EQ(d.environment.size(), 1u);
  EXPECT_NEAR(std::log(d.environment.front().values.front()), std::log(1.5), 0.1);
}

}  // namespace
}  // namespace fatmc
