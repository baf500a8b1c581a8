// The whole way from records to an answer, on a short experiment (diagnosis_bench.h).
#include "core/discrepancy/diagnosis.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "core/discrepancy/basis_file.h"
#include "core/discrepancy/effect_knowledge.h"
#include "core/discrepancy/effect_size.h"
#include "core/discrepancy/fitted_law.h"
#include "core/discrepancy/resonance.h"
#include "core/discrepancy/separability.h"
#include "tests/unit/discrepancy/diagnosis_bench.h"

namespace fatmc {
namespace {

TEST_F(DiagnosisOfARecord, OfTheModelItselfIsNone) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const Diagnosis d = bench_->answer(bench_->record({}, seed));
    EXPECT_EQ(d.verdict, Verdict::none) << d.evidence.leading;
    EXPECT_TRUE(d.effects.empty());
  }
}

TEST_F(DiagnosisOfARecord, NamesAHiddenDelayWithItsIntervalAndClosesTheGap) {
  const Effect hidden = *parse_effect("transport_delay:delay_s=0.03");
  const Diagnosis d = bench_->answer(bench_->record({hidden}, 4));
  ASSERT_EQ(d.verdict, Verdict::named);
  ASSERT_EQ(d.effects.size(), 1u);
  EXPECT_EQ(d.effects.front().effect.id, "transport_delay");
  const ParameterEstimate& delay = d.effects.front().parameters.front();
  // Twice the 95 % interval on either side: four standard errors.
  EXPECT_NEAR(delay.value, 0.03, delay.high - delay.low);
  EXPECT_GT(d.holdout.before, 2.0 * d.holdout.floor);
  EXPECT_LT(d.holdout.after - d.holdout.floor, 0.1 * (d.holdout.before - d.holdout.floor));
}

TEST_F(DiagnosisOfARecord, NamesTwoEffectsAtOnce) {
  const Diagnosis d =
      bench_->answer(bench_->record({*parse_effect("control_effectiveness:axis=roll,factor=0.8"),
                                     *parse_effect("gyro_scale:axis=pitch,error=0.1")},
                                    5));
  ASSERT_EQ(d.verdict, Verdict::named);
  std::set<std::string> names;
  for (const FoundEffect& f : d.effects) names.insert(f.effect.name());
  EXPECT_EQ(names, (std::set<std::string>{"control_effectiveness:axis=roll", "gyro_scale:axis=pitch"}));
}

TEST_F(DiagnosisOfARecord, IsUnknownWhereNoCandidateExplainsIt) {
  // A tone between two lines is no candidate.
  const Diagnosis d = bench_->answer(
      bench_->record({*parse_effect("tone:axis=pitch,amplitude_deg_s=1,frequency_hz=0.8125")}, 6));
  EXPECT_EQ(d.verdict, Verdict::unknown);
}

TEST_F(DiagnosisOfARecord, TheLawWithoutEffectsIsThatOfTheModel) {
  const Comparison comparison({{&bench_->model, bench_->basis.get(), bench_->record({}, 8)}}, 2);
  // An effect at its nominal value: the flights are those of the model, bit for bit.
  const auto law = FittedLaw::of(comparison, {*parse_effect("mass:factor=1")}, FittedLaw::kFlights);
  ASSERT_TRUE(law);
  EXPECT_LT(law->change().norm(), 1e-9);
  EXPECT_LT((law->deviation().array() - 1.0).abs().maxCoeff(), 1e-6);
  EXPECT_LT(law->excess(), 1e-9);
  EXPECT_NEAR(law->scan_ratio(), 1.0, 1e-6);
}

TEST_F(DiagnosisOfARecord, TheLawWithTwiceTheTurbulenceIsTheScatterOfOtherFlightsWithIt) {
  const Comparison comparison({{&bench_->model, bench_->basis.get(), bench_->record({}, 9)}}, 2);
  const std::vector<std::vector<Effect>> sets = {{*parse_effect("turbulence:factor=2")}};
  const auto law = FittedLaw::of(comparison, sets.front(), FittedLaw::kFlights);
  ASSERT_TRUE(law);
  const FeatureLayout& layout = bench_->layout;
  // The scatter of 60 other flights over that of the model's own with the same noise; the median over flights, since a flight
  // that the gusts have banked far has many times the others' scatter.
  const auto white = [&](const std::vector<Effect>& effects) {
    const std::vector<std::vector<Effect>> one = {effects};
    const Eigen::MatrixXd features = bench_->model.fly(one, 400, 60, 2).front().features;
    const Eigen::VectorXd mean = features.rowwise().mean();
    return bench_->basis->law.whiten(layout, features.colwise() - mean);
  };
  const Eigen::MatrixXd with = white(sets.front()), without = white({});
  double by_law = 0.0;
  std::vector<int> rows;
  for (const FeatureBlock& block : layout.blocks) {
    if (block.kind != FeatureKind::line) continue;
    for (int row = block.first; row < block.first + 3; ++row) {
      rows.push_back(row);
      by_law += law->deviation()[row] * law->deviation()[row];
    }
  }
  std::vector<double> ratios;
  for (int n = 0; n < 60; ++n) {
    ratios.push_back(with(rows, n).squaredNorm() / without(rows, n).squaredNorm());
  }
  std::nth_element(ratios.begin(), ratios.begin() + 30, ratios.end());
  EXPECT_GT(ratios[30], 2.0) << "of p, q, r at 40 lines: gusts stand above the gyros' noise";
  EXPECT_NEAR(by_law / static_cast<double>(rows.size()) / ratios[30], 1.0, 0.1);
  // An estimate that reads one feature has its deviation, with what 16 flights leave uncertain (four standard errors).
  Eigen::MatrixXd one = Eigen::MatrixXd::Zero(1, comparison.size());
  one(0, layout.blocks[10].first) = 1.0;
  EXPECT_NEAR(law->spread(one).deviation[0] / law->deviation()[layout.blocks[10].first], 1.0, 4.0 * 0.18);
}

TEST_F(DiagnosisOfARecord, AModeIsFoundBetweenTheSignaturesOfTheDictionary) {
  // 1.03 Hz and a width of 6 %: none of the modes that are flown is near.
  const Effect hidden = *parse_effect("flexible_mode:axis=yaw,slope=0.01,frequency_hz=1.03,damping=0.03");
  const ResonanceGrid grid = resonance_grid(bench_->layout, *broad_resonance(hidden), [&] {
    const std::vector<std::vector<Effect>> sets = {{*broad_resonance(hidden)}};
    const EffectFlights flown = bench_->model.fly(sets, 0, 2, 2).front();
    return Eigen::VectorXd((flown.features - bench_->basis->baseline.leftCols(2)).rowwise().mean());
  }());
  const std::vector<std::vector<Effect>> sets = {{hidden}};
  const EffectFlights flown = bench_->model.fly(sets, 0, 2, 2).front();
  const Eigen::VectorXd change = (flown.features - bench_->basis->baseline.leftCols(2)).rowwise().mean();
  const int lines = bench_->layout.blocks[40].first;  // the features of the 40 lines stand first
  double best = 0.0;
  std::size_t at = 0;
  for (std::size_t e = 0; e < grid.effects.size(); ++e) {
    const Eigen::VectorXd one = grid.differences.col(static_cast<Eigen::Index>(e)).head(lines);
    const double cosine = one.dot(change.head(lines)) / (one.norm() * change.head(lines).norm());
    if (cosine > best) {
      best = cosine;
      at = e;
    }
  }
  EXPECT_NEAR(grid.effects[at].value("frequency_hz"), 1.03, 0.02 * 1.03);
  EXPECT_GT(best, 0.9);
}

TEST_F(DiagnosisOfARecord, SeparationsAreDistancesToTheNearestOtherEffect) {
  const Comparison comparison({{&bench_->model, bench_->basis.get(), bench_->record({}, 10)}}, 2);
  const std::vector<Separation> all = separations(comparison);
  ASSERT_GT(all.size(), 40u);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Separation& s = all[i];
    EXPECT_NE(s.effect.name(), s.nearest.name());
    EXPECT_GT(s.left, 0.0) << s.effect.text();
    const double sine = std::sin(s.angle_deg * kPi / 180.0);
    EXPECT_NEAR(s.left, s.energy * sine * sine, 1e-6 * s.energy);
    if (i > 0) {
      EXPECT_GE(s.left, all[i - 1].left);
    }
  }
}

TEST_F(DiagnosisOfARecord, DoesNotDependOnTheNumberOfThreads) {
  const Eigen::VectorXd features = bench_->record({*parse_effect("mass:factor=1.2")}, 7);
  const Diagnosis one = bench_->answer(features, 1), three = bench_->answer(features, 3);
  EXPECT_EQ(one.effect_list(), three.effect_list());
  EXPECT_EQ((one.residual - three.residual).norm(), 0.0);
}

TEST_F(DiagnosisOfARecord, ABasisReadsBackBitForBitAndIsRefusedWhenDamagedOrForeign) {
  const std::string text = basis_text(*bench_->basis, "key");
  const auto same = parse_basis(text, "key", bench_->layout, bench_->grid, bench_->options);
  ASSERT_TRUE(same);
  EXPECT_EQ(basis_text(*same, "key"), text);
  EXPECT_EQ((same->atoms - bench_->basis->atoms).norm(), 0.0);
  EXPECT_FALSE(parse_basis(text, "another", bench_->layout, bench_->grid, bench_->options));
  EXPECT_FALSE(
      parse_basis(text.substr(0, text.size() - 1), "key", bench_->layout, bench_->grid, bench_->options));
  std::string damaged = text;
  damaged[text.size() / 2] = static_cast<char>(damaged[text.size() / 2] ^ 1);
  EXPECT_FALSE(parse_basis(damaged, "key", bench_->layout, bench_->grid, bench_->options));
  EXPECT_FALSE(parse_basis("", "key", bench_->layout, bench_->grid, bench_->options));
}

TEST(EffectKnowledge, SpeaksOfEffectsThatExist) {
  for (const EffectKnowledge& known : effect_knowledge()) {
    EXPECT_NE(find_effect(known.id), nullptr) << known.id;
    for (const std::string_view other : known.confusable) EXPECT_NE(find_knowledge(other), nullptr) << other;
  }
  EXPECT_GE(effect_knowledge().size(), 24u);
}

TEST(EffectSize, AFactorIsAsLargeAsItsReciprocal) {
  Effect effect = *parse_effect("mass:factor=0.9");
  const double size = relative_size(effect);
  effect.values[0] = 1.0 / 0.9;
  EXPECT_NEAR(relative_size(effect), size, 1e-12);
  effect.values[0] = 1.0;
  EXPECT_EQ(relative_size(effect), 0.0);
}

}  // namespace
}  // namespace fatmc
