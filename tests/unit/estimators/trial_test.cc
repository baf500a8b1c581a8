// A trial of the estimator study in cases whose answer is known.
#include "campaigns/estimators/trial.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "campaigns/base/prepared_trials.h"
#include "campaigns/base/published_figures.h"
#include "campaigns/estimators/row_arrays.h"
#include "coordinator/input/toml_file.h"

namespace fatmc::estimators {
namespace {

CampaignSpec shipped(const char* file = "campaigns/estimators/spec.toml") {
  return *decode_campaign(*read_toml_resolved(file));
}

std::uint32_t cell_named(const CampaignSpec& spec, const std::string& name) {
  for (std::uint32_t i = 0; i < spec.cells.size(); ++i) {
    if (spec.cells[i].name == name) return i;
  }
  throw std::runtime_error("no cell " + name);
}

Tree& at(Tree& tree, std::initializer_list<std::string_view> path) {
  Tree* here = &tree;
  for (const std::string_view key : path) here = const_cast<Tree*>(here->find(key));
  return *here;
}

double largest(const TrialRow& row, const Estimator& estimator) {
  const auto& re = *row.array(name_of(estimator, kErrorReal));
  const auto& im = *row.array(name_of(estimator, kErrorImag));
  double out = 0.0;
  for (std::size_t k = 0; k < re.size(); ++k) out = std::max(out, std::hypot(re[k], im[k]));
  return out;
}

TEST(EstimatorTrial, DependsOnItsRepetitionAlone) {
  const CampaignSpec spec = shipped();
  const auto first = prepare_trials(kTrialStudy, spec, 0), second = prepare_trials(kTrialStudy, spec, 0);
  ASSERT_TRUE(first && second);
  const TrialRow before = (*first)->run(3);
  (*second)->run(7);
  EXPECT_EQ(before, (*second)->run(3));
  EXPECT_NE(content_hash(before), content_hash((*second)->run(4)));
}

TEST(EstimatorTrial, HoldsEveryLineOfEveryEstimator) {
  const CampaignSpec spec = shipped();
  for (const auto& [cell, lines] : {std::pair{"linear", 18U}, std::pair{"nonlinear", 20U}}) {
    const TrialRow row = (*prepare_trials(kTrialStudy, spec, cell_named(spec, cell)))->run(0);
    EXPECT_EQ(row.outcome, "ok") << row.detail;
    EXPECT_EQ(row.array(kFrequency)->size(), lines);
    for (const Estimator& estimator : kEstimators) {
      for (const auto what : {kErrorReal, kErrorImag, kVariance})
        EXPECT_EQ(row.array(name_of(estimator, what))->size(), lines)
            << cell << " " << name_of(estimator, what);
    }
  }
}

// Without noise the ETFE errs by the transient's share in the mean over P periods: sums of a transient that has died out by
// then, so that forty periods leave a twentieth of what two do (more where the slowest mode outlives the second period, but
// never more than a tenth for modes that lose a third a period). The transient LPM errs by what a quadratic through bins
// within 0.007 Hz leaves of C (zI - A)^-1 dx, whose poles are 0.07 Hz and more away: (0.007/0.07)^3 of the ETFE's error, which
// is 3e-3; interpolated instead of extrapolated it is smaller still.
TEST(EstimatorTrial, TransientLpmIsExactWhereTheTransientIsAPolynomialOfFrequency) {
  CampaignSpec spec = shipped();
  at(spec.tree, {"experiment", "excitation", "periods"}).value = std::int64_t{40};
  const TrialRow few = (*prepare_trials(kTrialStudy, shipped(), 0))->run(0);
  const TrialRow many = (*prepare_trials(kTrialStudy, spec, 0))->run(0);
  ASSERT_EQ(many.outcome, "ok");
  // Transients fall with the number of periods by at least that number's ratio, for both.
  EXPECT_LT(largest(many, kEstimators[0]), largest(few, kEstimators[0]) / 10.0);
  EXPECT_LT(largest(many, kEstimators[1]), 3e-6);
  EXPECT_LT(largest(many, kEstimators[1]), largest(many, kEstimators[0]) / 100.0);
}

// The fast LPM's error without noise is its interpolation error: in windows at the border, the largest, it goes with the
// third power (R + 1) of the spacing. A tenth of the spacing leaves a thousandth, but for weights |U|^2 within a window, which
// differ by factors below 3.
TEST(EstimatorTrial, InterpolationErrorOfTheFastLpmFallsWithTheThirdPowerOfTheSpacing) {
  CampaignSpec spec = shipped();
  Tree& excitation = at(spec.tree, {"experiment", "excitation"});
  excitation.set("period_s", Tree{200.0, {}, 0});
  const auto ranges = [](double step) {
    const Tree row{Tree::Array{{Tree{0.3, {}, 0}, Tree{0.8, {}, 0}, Tree{step, {}, 0}}}, {}, 0};
    return Tree{Tree::Array{{row}}, {}, 0};
  };
  excitation.set("ranges_hz", ranges(0.05));
  const TrialRow coarse = (*prepare_trials(kTrialStudy, spec, 0))->run(0);
  at(spec.tree, {"experiment", "excitation"}).set("ranges_hz", ranges(0.005));
  const TrialRow fine = (*prepare_trials(kTrialStudy, spec, 0))->run(0);
  const double ratio = largest(coarse, kEstimators[2]) / largest(fine, kEstimators[2]);
  EXPECT_GT(ratio, 1000.0 / 3.0);
  EXPECT_LT(ratio, 3000.0);
}

TEST(EstimatorTrial, LongitudinalGustsLeaveTheLateralChannelsAtZero) {
  const CampaignSpec spec = shipped();
  const auto cell = prepare_trials(kTrialStudy, spec, cell_named(spec, "nonlinear, light turbulence"));
  const TrialRecord record = *(*cell)->record(0);
  for (std::size_t c = 0; c < record.names.size(); ++c) {
    const double peak = record.columns.col(static_cast<Eigen::Index>(c)).cwiseAbs().maxCoeff();
    const std::string& name = record.names[c];
    const bool lateral = name == "p" || name == "r" || name == "phi" || name == "xi_c" || name == "zeta_c";
    if (lateral) {
      EXPECT_EQ(peak, 0.0) << name;
    } else if (name == "q") {
      EXPECT_GT(peak, 0.01);
    }
  }
}

TEST(EstimatorTrial, SeveralExcitedAxesAreRefusedByName) {
  CampaignSpec spec = shipped();
  at(spec.tree, {"experiment", "excitation"})
      .set("amplitude_rad_s",
           Tree{Tree::Array{{Tree{0.1, {}, 0}, Tree{0.1, {}, 0}, Tree{0.0, {}, 0}}}, {}, 0});
  const auto cell = prepare_trials(kTrialStudy, spec, 0);
  ASSERT_FALSE(cell);
  EXPECT_EQ(cell.error().key, "experiment.excitation.amplitude_rad_s");
}

TEST(EstimatorTrial, AWindowWithoutADegreeOfFreedomIsRefusedByName) {
  CampaignSpec spec = shipped();
  at(spec.tree, {"estimator", "n_e"}).value = std::int64_t{1};
  const auto cell = prepare_trials(kTrialStudy, spec, 0);
  ASSERT_FALSE(cell);
  EXPECT_EQ(cell.error().file, "campaigns/estimators/spec.toml");
  EXPECT_EQ(cell.error().key, "estimator.n-e");
}

TEST(EstimatorTrial, AFlightThatLeavesTheModelIsAnOutcomeOfItsRow) {
  CampaignSpec spec = shipped();
  at(spec.tree, {"experiment", "excitation"})
      .set("amplitude_rad_s",
           Tree{Tree::Array{{Tree{0.0, {}, 0}, Tree{2.0, {}, 0}, Tree{0.0, {}, 0}}}, {}, 0});
  const TrialRow row = (*prepare_trials(kTrialStudy, spec, cell_named(spec, "nonlinear")))->run(0);
  EXPECT_EQ(row.outcome, "diverged");
  EXPECT_NE(row.detail.find(" at "), std::string::npos);
  EXPECT_EQ(row.array(kFrequency), nullptr);
}

TEST(EstimatorSpecs, PublishedFiguresNameRowsOfTheTables) {
  const auto published = decode_published(shipped());
  ASSERT_TRUE(published) << published.error().text();
  EXPECT_EQ(published->size(), 15U + 15U + 2U + 3U + 4U);
  for (const PublishedFigure& figure : *published) EXPECT_TRUE(figure.source.starts_with("T line "));
}

}  // namespace
}  // namespace fatmc::estimators
