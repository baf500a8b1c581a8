#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "campaigns/base/prepared_trials.h"
#include "campaigns/candidates/candidates_spec.h"
#include "campaigns/candidates/flight_test.h"
#include "campaigns/candidates/maneuver_validation.h"
#include "campaigns/candidates/model_analysis.h"
#include "campaigns/candidates/model_table.h"
#include "campaigns/candidates/summary.h"
#include "campaigns/candidates/trial.h"
#include "coordinator/input/toml_file.h"
#include "core/subspace/model_fit.h"

namespace fatmc::candidates {
namespace {

CampaignSpec shipped_spec() {
  return *decode_campaign(*read_toml_resolved("campaigns/candidates/spec.toml"));
}

Tree& at(Tree& tree, std::initializer_list<std::string_view> path) {
  Tree* here = &tree;
  for (const std::string_view key : path) here = const_cast<Tree*>(here->find(key));
  return *here;
}

Tree integer(std::int64_t value) { return {value, {}, 0}; }

/// Short windows and orders: a second of work.
CampaignSpec tiny_spec() {
  CampaignSpec spec = shipped_spec();
  Tree& identification = at(spec.tree, {"identification"});
  identification.set("past_high", integer(40));
  identification.set("block", integer(2));
  identification.set("order_low", integer(11));
  identification.set("order_high", integer(18));
  return spec;
}

CandidatesSpec decoded(const CampaignSpec& spec, std::uint32_t cell = 0) {
  return *decode_candidates(*spec_of_cell(spec, cell));
}

/// One row, for as long as it lives.
RowSource source_of(const TrialRow& row) {
  return [&row](std::uint32_t, const std::function<void(const TrialRow&)>& visit) { visit(row); };
}

TEST(CandidatesSpec, TheShippedOneHasTheWindowsAndModelsOfThePaper) {
  const CandidatesSpec spec = decoded(shipped_spec());
  ASSERT_EQ(spec.identification.pasts.size(), 99U);
  EXPECT_EQ(spec.identification.pasts.front(), 994);
  EXPECT_EQ(spec.identification.pasts[1], 990);
  EXPECT_EQ(spec.identification.pasts.back(), 20);
  const std::size_t windows = 99 * 100 / 2;  // f in M_p, f <= p
  EXPECT_EQ(windows, 4950U);
  EXPECT_EQ(windows * 13, 64350U);
  EXPECT_EQ(std::lround(spec.selections[0].share * 4950), 750);
  EXPECT_EQ(std::lround(spec.selections[1].share * 4950), 125);
  EXPECT_EQ(spec.identification.blocks(), shipped_spec().cells.front().repetitions);
}

TEST(CandidatesSpec, BlocksHoldEveryPastOnceAndDescend) {
  const Identification identification = decoded(shipped_spec()).identification;
  std::vector<int> all;
  for (std::size_t block = 0; block < identification.blocks(); ++block) {
    const std::vector<int> pasts = identification.block_pasts(block);
    all.insert(all.end(), pasts.begin(), pasts.end());
  }
  EXPECT_EQ(all, identification.pasts);
  EXPECT_TRUE(identification.block_pasts(identification.blocks()).empty());
}

TEST(CandidatesSpec, WrongValuesAreRefusedWithTheirPlace) {
  CampaignSpec spec = shipped_spec();
  at(spec.tree, {"identification"}).set("past_high", integer(995));
  const auto refused = prepare_trials(kTrialStudy, spec, 0);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("the largest for these sweeps is 994"), std::string::npos);
  spec = shipped_spec();
  Tree::Array none;
  for (int k = 0; k < kOutputs; ++k) none.items.push_back({0.0, {}, 0});
  at(spec.tree, {"validation"}).set("weights", {none, {}, 0});
  EXPECT_EQ(prepare_trials(kTrialStudy, spec, 0).error().key, "validation.weights");
  spec = shipped_spec();
  at(spec.tree, {"model"}).set("outputs", at(spec.tree, {"model", "inputs"}));
  const auto channels = prepare_trials(kTrialStudy, spec, 0);
  ASSERT_FALSE(channels);
  EXPECT_EQ(channels.error().key, "model.outputs");
}

TEST(FlightTest, SweepsAndMultistepsAreThoseOfTable1) {
  const CampaignSpec spec = shipped_spec();
  const CandidatesSpec own = decoded(spec);
  const FlownTest flown = fly_test(own.truth, own.flight, spec.trial_seed({0, 0}));
  ASSERT_EQ(flown.sweeps.size(), 8U);
  Eigen::Index samples = 0;
  for (const Maneuver& sweep : flown.sweeps) samples += sweep.samples();
  EXPECT_EQ(samples, 19880);
  EXPECT_EQ(largest_past_window(flown.sweeps), 994);
  for (std::size_t j = 0; j < 8; ++j) {
    const auto control = static_cast<Eigen::Index>(j / 2);
    const double step = own.flight.multistep_amplitude_pct[j / 2];
    const Eigen::VectorXd input = flown.multisteps[j].inputs.col(control);
    EXPECT_DOUBLE_EQ(input.maxCoeff(), step);
    EXPECT_DOUBLE_EQ(input.minCoeff(), -step);
    EXPECT_EQ(input(60) > 0.0, j % 2 == 0);  // the second of a control begins the other way
    // The primary control moves most; the others hold by pulses of 5 % at most.
    for (Eigen::Index other = 0; other < kInputs; ++other) {
      if (other == control) continue;
      EXPECT_LE(flown.sweeps[j].inputs.col(other).cwiseAbs().maxCoeff(), 5.0);
    }
  }
}

TEST(FlightTest, WithoutNoiseAndGustsTheMultistepsAreTheModelsResponse) {
  const CampaignSpec spec = shipped_spec();
  CandidatesSpec own = decoded(spec);
  own.flight.noise.assign(kOutputs, 0.0);
  own.flight.gust_m_s = 0.0;
  const FlownTest flown = fly_test(own.truth, own.flight, spec.trial_seed({0, 0}));
  const auto validation = validate(*modal_model(own.truth.model), flown.multisteps);
  ASSERT_TRUE(validation.has_value());
  EXPECT_NEAR(validation->overall.agreement, 1.0, 1e-9);
  EXPECT_NEAR(validation->overall.rms, 0.0, 1e-8);
}

TEST(FlightTest, InGustsTheTruthItselfIsAdequateAndNoMore) {
  const CampaignSpec spec = shipped_spec();
  const CandidatesSpec own = decoded(spec);
  const FlownTest flown = fly_test(own.truth, own.flight, spec.trial_seed({0, 0}));
  const auto validation = validate(*modal_model(own.truth.model), flown.multisteps);
  ASSERT_TRUE(validation.has_value());
  EXPECT_EQ(agreement_rating(validation->overall.agreement), "adequate") << validation->overall.agreement;
}

TEST(FlightTest, TheScasFeedsBackTheMeasuredOutputsASampleLate) {
  const CampaignSpec spec = shipped_spec();
  CandidatesSpec own = decoded(spec, 1);
  EXPECT_EQ(own.flight.scas, 1.0);
  const FlownTest closed = fly_test(own.truth, own.flight, spec.trial_seed({1, 0}));
  const Maneuver& step = closed.multisteps[0];
  // Roll control of a pitch multistep: nothing but feedback, H (14).
  for (Eigen::Index t = 1; t < 50; ++t) {
    EXPECT_NEAR(step.inputs(t, 1), -60.0 * step.outputs(t - 1, 3) - 50.0 * step.outputs(t - 1, 6), 1e-12);
  }
}

TEST(Analysis, TheTruthHasThePublishedModesAndNoArtifact) {
  const CandidatesSpec own = decoded(shipped_spec());
  const auto truth = truth_response(own.truth.model, own.truth.rate_hz);
  ASSERT_TRUE(truth.has_value()) << truth.error().message;
  const auto analysis = analyse(truth->bare, truth->magnitude_db, *truth);
  ASSERT_TRUE(analysis.has_value()) << analysis.error().message;
  for (std::size_t i = 0; i < kTrackedModes.size(); ++i) {
    EXPECT_NEAR(analysis->period_s[i], kTrackedModes[i].period_s, 1e-3 * kTrackedModes[i].period_s);
    EXPECT_NEAR(analysis->damping[i], kTrackedModes[i].damping, 1e-3);
  }
  EXPECT_EQ(analysis->artifacts, 0);
  EXPECT_EQ(analysis->level[0], 2);  // pitch, bare
  EXPECT_EQ(analysis->level[1], 1);  // pitch, SCAS
  EXPECT_EQ(analysis->level[2], 2);  // roll, SCAS: the lead-lag mode
  EXPECT_EQ(analysis->approval[0], 2);
  EXPECT_EQ(analysis->approval[1], 1);
}

TEST(Analysis, AResonanceOfTheRollResponseThatTheTruthLacksIsAnArtifact) {
  const CandidatesSpec own = decoded(shipped_spec());
  const auto truth = truth_response(own.truth.model, own.truth.rate_hz);
  ASSERT_TRUE(truth.has_value());
  // The truth with an oscillator of 0.4 rad/s beside it, D 0.02, whose peak of residue/(2 |Re s|) is `peak` times |p/delta_y|
  // of the truth there.
  const auto beside = [&](double peak) {
    ContinuousModel out = truth->bare;
    const Eigen::Index n = out.a.rows();
    const double w = 0.4, decay = 0.02 * w;
    const double at_w =
        std::pow(10.0, roll_magnitude_db(truth->bare, {&w, 1}).front() / 20.0) * std::numbers::pi / 180.0;
    out.a.conservativeResizeLike(Eigen::MatrixXd::Zero(n + 2, n + 2));
    out.a.bottomRightCorner<2, 2>() << -decay, w, -w, -decay;
    out.b.conservativeResizeLike(Eigen::MatrixXd::Zero(n + 2, out.b.cols()));
    out.b(n, 1) = 1.0;
    out.c.conservativeResizeLike(Eigen::MatrixXd::Zero(out.c.rows(), n + 2));
    out.c(3, n) = 2.0 * decay * peak * at_w;
    return out;
  };
  const auto artifacts = [&](double peak) {
    const ContinuousModel model = beside(peak);
    return analyse(model, roll_magnitude_db(model, study_frequencies()), *truth)->artifacts;
  };
  EXPECT_EQ(artifacts(0.2), 0);
  EXPECT_EQ(artifacts(5.0), 1);
}

TEST(CandidatesTrial, ARowHoldsEveryModelOfItsBlockAndDependsOnItsBlockAlone) {
  const CampaignSpec spec = tiny_spec();
  const auto cell = prepare_trials(kTrialStudy, spec, 0), again = prepare_trials(kTrialStudy, spec, 0);
  ASSERT_TRUE(cell && again) << cell.error().text();
  const TrialRow row = (*cell)->run(0);  // p = 40, 30: f = 20, 30, 40 and 20, 30
  (*again)->run(1);
  EXPECT_EQ(content_hash(row), content_hash((*again)->run(0)));
  EXPECT_EQ(row.outcome, "ok");
  ASSERT_NE(row.array(kPast), nullptr);
  EXPECT_EQ(row.array(kPast)->size(), 5U * 8U);
  EXPECT_EQ(row.array(kRollRms)->size(), row.array(kPast)->size());
  EXPECT_EQ(row.array(kMagnitude)->size(), row.array(kAnalysed)->size() * kFrequencies);
  EXPECT_EQ((*cell)->run(2).outcome, "no_block");
  for (const auto& [name, values] : row.arrays) {
    EXPECT_TRUE(std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); })) << name;
  }
}

TEST(CandidatesTrial, TablesAndFiguresComeFromItsRows) {
  CampaignSpec spec = tiny_spec();
  spec.cells.resize(1);
  const auto cell = prepare_trials(kTrialStudy, spec, 0);
  ASSERT_TRUE(cell);
  const std::vector<TrialRow> stored = {(*cell)->run(0), (*cell)->run(1), (*cell)->run(2)};
  const RowSource rows = [&](std::uint32_t, const std::function<void(const TrialRow&)>& visit) {
    for (const TrialRow& row : stored) visit(row);
  };
  const auto found = tables(spec, rows);
  ASSERT_TRUE(found);
  const auto count = std::count_if(found->begin(), found->end(), [](const TableRow& row) {
    return row.table == "Fig. 4" && row.quantity == "median";
  });
  EXPECT_EQ(count, 8);  // n = 11 ... 18
  // No norm is below 1e-3 at p = 40: the claims about such candidates stand all the same.
  const auto claim = std::find_if(found->begin(), found->end(), [](const TableRow& row) {
    return row.quantity == "T_P" && row.row.starts_with("phugoid, bare, norm");
  });
  ASSERT_NE(claim, found->end());
  EXPECT_EQ(claim->verdict, "differs");
  EXPECT_EQ(claim->why, "no model has a norm below the limit");
  const auto drawn = figures(spec, rows);
  ASSERT_TRUE(drawn);
  EXPECT_EQ(drawn->size(), 13U);  // Figs. 2 to 5, 6 and 7 of four selections, 8 to 12
}

TEST(CandidatesTrial, ModelsComeBackFromTheirRowsAsTheyWereValidated) {
  const CampaignSpec spec = tiny_spec();
  const CandidatesSpec own = decoded(spec);
  const auto cell = prepare_trials(kTrialStudy, spec, 0);
  ASSERT_TRUE(cell);
  const TrialRow stored = (*cell)->run(1);  // p = 20
  const ModelTable table = *read_models(0, source_of(stored));
  const FlownTest flown = recorded_test(own.truth, own.flight, spec.trial_seed({0, 0}));
  int compared = 0;
  for (std::size_t i = 0; i < table.models.size(); ++i) {
    const ModelAnalysisRow* analysis = table.analysis_of(i);
    if (analysis == nullptr) continue;
    ASSERT_EQ(analysis->model.model.a.rows(), table.models[i].order);
    const auto again = validate(analysis->model, flown.multisteps);
    ASSERT_TRUE(again.has_value());
    EXPECT_NEAR(again->overall.agreement, table.models[i].agreement, 1e-10);
    EXPECT_NEAR(again->roll_rms, table.models[i].roll_rms, 1e-10);
    EXPECT_NEAR(again->overall.theil, table.models[i].theil, 1e-10);
    for (std::size_t k = 0; k < kOutputs; ++k)
      EXPECT_NEAR(again->overall.output_agreement[k], table.models[i].output_agreement[k], 1e-10);
    ++compared;
  }
  EXPECT_GE(compared, 1);  // of n = 12 and 18, those with a continuous counterpart
}

TEST(CandidatesTrial, RowsOfAnotherVersionOfTheStudyAreRefusedWithWhatIsMissing) {
  const auto cell = prepare_trials(kTrialStudy, tiny_spec(), 0);
  ASSERT_TRUE(cell);
  const TrialRow whole = (*cell)->run(1);
  ASSERT_TRUE(read_models(0, source_of(whole)));
  TrialRow without = whole;
  std::erase_if(without.arrays, [](const auto& array) { return array.first == kTheil; });
  const auto refused = read_models(0, source_of(without));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().key, kTheil);
  EXPECT_NE(refused.error().message.find("run the spec into a new one"), std::string::npos);
  TrialRow shorter = whole;
  for (auto& [name, values] : shorter.arrays) {
    if (name == kMagnitude) values.pop_back();
  }
  EXPECT_EQ(read_models(0, source_of(shorter)).error().key, kMagnitude);
  TrialRow uncounted = whole;
  std::erase_if(uncounted.metrics, [](const auto& metric) { return metric.first == kNotContinuous; });
  EXPECT_EQ(read_models(0, source_of(uncounted)).error().key, kNotContinuous);
  CampaignSpec spec = tiny_spec();
  EXPECT_EQ(tables(spec, source_of(without)).error().key, kTheil);
  EXPECT_EQ(figures(spec, source_of(without)).error().key, kTheil);
}

TEST(OverallAccuracy, IsTheHandCaseOfTwoOutputs) {
  Eigen::MatrixXd measured(4, 2), simulated(4, 2);
  measured << 1, 1, -1, -1, 2, 1, -2, -1;
  simulated << 0.5, 1, -0.5, -1, 1, 1, -1, -1;  // half of the first, all of the second
  const Eigen::RowVectorXd units = Eigen::RowVectorXd::Constant(2, 2.0);
  const auto equal = overall_accuracy(measured, simulated, units);
  ASSERT_TRUE(equal);
  EXPECT_NEAR(equal->output_agreement[0], 2.0 / 3.0, 1e-15);  // 1 - 3/(6 + 3)
  EXPECT_NEAR(equal->output_agreement[1], 1.0, 1e-15);
  EXPECT_NEAR(equal->agreement, std::sqrt(2.0 / 3.0), 1e-15);
  // Squares of the error 2.5, of the measured 10 + 4, of the simulated 2.5 + 4; units cancel in Theil's coefficient.
  EXPECT_NEAR(equal->rms, 2.0 * std::sqrt(2.5 / 8.0), 1e-15);
  EXPECT_NEAR(equal->theil, std::sqrt(2.5) / (std::sqrt(14.0) + std::sqrt(6.5)), 1e-15);
  const std::vector<double> weights = {2.0, 0.0};
  EXPECT_NEAR(overall_accuracy(measured, simulated, units, weights)->agreement, 2.0 / 3.0, 1e-15);
  simulated(0, 0) = 1e200;
  EXPECT_FALSE(overall_accuracy(measured, simulated, units));
}

TEST(CandidatesTrial, WeightsOfTheSpecChangeTheOverallAgreementAlone) {
  CampaignSpec spec = tiny_spec();
  const auto equal = prepare_trials(kTrialStudy, spec, 0);
  Tree::Array weights;
  for (const double w : {0.0, 0.0, 0.0, 8.0, 0.0, 0.0, 0.0, 0.0}) weights.items.push_back({w, {}, 0});
  at(spec.tree, {"validation"}).set("weights", {weights, {}, 0});
  const auto roll = prepare_trials(kTrialStudy, spec, 0);
  ASSERT_TRUE(equal && roll);
  const TrialRow one = (*equal)->run(1), other = (*roll)->run(1);
  EXPECT_EQ(*one.array(kOutputAgreement), *other.array(kOutputAgreement));
  EXPECT_EQ(*one.array(kTheil), *other.array(kTheil));
  const std::vector<double>&overall = *one.array(kAgreement), &weighted = *other.array(kAgreement);
  for (std::size_t i = 0; i < overall.size(); ++i) {
    const double* d1 = one.array(kOutputAgreement)->data() + i * kOutputs;
    EXPECT_NEAR(weighted[i], d1[3], 1e-12);
    double product = 1.0;
    for (int k = 0; k < kOutputs; ++k) product *= d1[k];
    EXPECT_NEAR(overall[i], std::pow(product, 1.0 / 8.0), 1e-12);
  }
}

ModelRow model(int past, double agreement, double norm) {
  return {past, 20, 12, ModelState::ok, agreement, 1.0, norm, agreement, 1.0, -1};
}

TEST(Selection, BestByAgreementAloneAndBehindTheNormsLimit) {
  ModelTable table;
  table.models = {model(20, 0.80, 1e-12), model(30, 0.95, 1e-3), model(40, 0.90, 1e-12),
                  model(50, 0.85, 1e-12)};
  table.models.push_back({60, 20, 12, ModelState::not_identified});
  table.models.push_back({20, 20, 18, ModelState::ok, 0.99, 1.0, 1e-12});
  const Selected selected = select(table, {12, 1e-10, 0.0, 0.4});  // two of five, failures among them
  EXPECT_EQ(selected.all, (std::vector<std::size_t>{1, 2, 3, 0}));
  EXPECT_EQ(selected.best, (std::vector<std::size_t>{1, 2}));
  EXPECT_EQ(selected.accepted, (std::vector<std::size_t>{2, 3, 0}));
  EXPECT_EQ(selected.candidates, (std::vector<std::size_t>{2, 3}));
  const Selected quarter = select(table, {12, 0.0, 0.75, 0.4});  // of four that were identified
  EXPECT_EQ(quarter.limit, 1e-12);                               // the third smallest norm
  EXPECT_EQ(quarter.accepted, (std::vector<std::size_t>{2, 3, 0}));
}

}  // namespace
}  // namespace fatmc::candidates
