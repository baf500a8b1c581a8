#include "campaigns/hidden_effect/trial.h"

#include <algorithm>
#include <cmath>

#include "campaigns/hidden_effect/hidden_cell.h"
#include "campaigns/hidden_effect/hidden_score.h"
#include "campaigns/hidden_effect/hidden_search.h"
#include "campaigns/hidden_effect/limit_size.h"
#include "campaigns/hidden_effect/row_metrics.h"
#include "core/discrepancy/diagnosis.h"
#include "core/discrepancy/fitted_law.h"

namespace fatmc::hidden_effect {
namespace {

class HiddenEffectTrials final : public PreparedCell {
 public:
  HiddenEffectTrials(HiddenCell cell, std::shared_ptr<const HiddenSearch> search, TrialSeed seed,
                     TrialKey key)
      : cell_(std::move(cell)), search_(std::move(search)), seed_(seed), key_(key) {}

  TrialRow run(std::uint64_t repetition) const override {
    TrialRow row;
    row.key = {key_.cell, repetition};
    const Drawn drawn = drawn_by(repetition);
    write_key(drawn, row);
    const auto seen = features(drawn, repetition, kRecord, row);
    const auto unseen = features(drawn, repetition, kScoring, row);
    if (!seen || !unseen) return row;
    const auto levels = search_->prepared();
    if (!levels) {
      row.outcome = "unprepared";
      row.detail += "; " + Error{{}, 0, levels.error().key, levels.error().message}.text();
      return row;
    }
    DiagnosisOptions options;
    if (cell_.tier.taken_out) {
      for (const Effect& e : drawn.effects) options.excluded.push_back(e.id);
    }
    if (cell_.tier.draw.turbulence_error > 0.0) options.nuisances = variants_named({"turbulence"});
    const Diagnosis diagnosis = diagnose(Comparison(compared(**levels, *seen), 1), nullptr, options);
    write_answer(drawn, diagnosis, cell_.classes, row);
    write_gap(Comparison(compared(**levels, *unseen), 1), diagnosis, row);
    return row;
  }

  /// What the diagnosis was given; of several levels, the first.
  std::optional<TrialRecord> record(std::uint64_t repetition) const override {
    const auto flight = hidden_flight(drawn_by(repetition), 0);
    if (!flight) return std::nullopt;
    FlightRecord flown;
    flight->fly(search_->model(0).reference(), noise(repetition, kRecord, 0), flown);
    return trial_record(flown, cell_.flown.experiment, search_->model(0).aircraft());
  }

 private:
  static constexpr const char* kRecord = "record";
  static constexpr const char* kScoring = "scoring";

  [[nodiscard]] Drawn drawn_by(std::uint64_t repetition) const {
    TrialSeed seed = seed_;
    seed.repetition = repetition;
    RandomStream random(seed, "hidden");
    Drawn out = draw(cell_.tier.draw, random);
    const ModelSimulator& model = search_->model(0);
    for (Effect& effect : out.effects) {
      effect =
          share_of_limit(effect, cell_.tier.draw.size, model.aircraft(), model.setup(), model.reference());
    }
    return out;
  }

  /// The aircraft that is recorded: the model, effects of its own included, with what was drawn.
  [[nodiscard]] Result<Flight> hidden_flight(const Drawn& drawn, std::size_t level) const {
    const ModelSimulator& model = search_->model(level);
    std::vector<Effect> all = model.own_effects();
    all.insert(all.end(), drawn.errors.begin(), drawn.errors.end());
    all.insert(all.end(), drawn.effects.begin(), drawn.effects.end());
    const auto modified = apply(model.aircraft(), model.setup(), all);
    if (!modified) return fail(modified.error());
    return Flight::prepare(modified->aircraft, modified->setup);
  }

  /// Gusts and gyro noise of the trial's own stream, one a purpose and level.
  [[nodiscard]] TrialSeed noise(std::uint64_t repetition, std::string_view purpose, std::size_t level) const {
    TrialSeed seed = seed_;
    seed.repetition = repetition;
    seed.study ^= name_hash(purpose);
    if (level > 0) seed.study ^= name_hash("level " + std::to_string(level));
    return seed;
  }

  /// Features of a flight a level, with what was drawn.
  std::optional<std::vector<Eigen::VectorXd>> features(const Drawn& drawn, std::uint64_t repetition,
                                                       std::string_view purpose, TrialRow& row) const {
    std::vector<Eigen::VectorXd> out;
    const auto stop = [&](const std::string& why) {
      row.outcome = "diverged";
      row.detail += "; " + why;
      return std::nullopt;
    };
    for (std::size_t level = 0; level < search_->level_count(); ++level) {
      const auto flight = hidden_flight(drawn, level);
      if (!flight) return stop(flight.error().text());
      const ModelSimulator& model = search_->model(level);
      FlightRecord flown;
      flight->fly(model.reference(), noise(repetition, purpose, level), flown);
      if (flown.ending != Ending::completed) return stop(std::string(name(flown.ending)));
      out.push_back(model.extractor().extract(
          {flown.reference, flown.input, flown.output, flown.auxiliary.leftCols(2), flown.auxiliary.col(2)}));
    }
    return out;
  }

  static std::vector<ComparedRecord> compared(const std::vector<SearchLevel>& levels,
                                              const std::vector<Eigen::VectorXd>& features) {
    std::vector<ComparedRecord> out;
    for (std::size_t i = 0; i < levels.size(); ++i)
      out.push_back({levels[i].model.get(), &levels[i].basis, features[i]});
    return out;
  }

  static void write_gap(const Comparison& unseen, const Diagnosis& d, TrialRow& row) {
    const auto features = static_cast<double>(unseen.size());
    const double floor = unseen.thresholds().energy_mean, before = unseen.discrepancy().squaredNorm();
    double after = before;
    if (!d.effects.empty() && d.verdict != Verdict::unknown) {
      // By the law of chance with the effects: those that make noise leave more of it, which is no gap.
      std::vector<Effect> all = d.environment;
      for (const FoundEffect& found : d.effects) all.push_back(found.effect);
      const auto law = FittedLaw::of(unseen, all, ComparisonBasis::kBaseline);
      if (law) {  // else what was named cannot be flown: nothing is gained
        after = (unseen.discrepancy() - law->change()).cwiseQuotient(law->deviation()).squaredNorm() -
                law->excess();
      }
    }
    row.metrics.emplace_back(kGapBefore, before / features);
    row.metrics.emplace_back(kGapAfter, after / features);
    row.metrics.emplace_back(kGapFloor, floor / features);
    if (before > unseen.thresholds().energy)
      row.metrics.emplace_back(kGapLeft, std::max(0.0, (after - floor) / (before - floor)));
  }

  HiddenCell cell_;
  std::shared_ptr<const HiddenSearch> search_;
  TrialSeed seed_;
  TrialKey key_;
};

Result<std::unique_ptr<PreparedCell>> prepare(const CampaignSpec& spec, std::uint32_t index) {
  auto cell = decode_hidden_cell(spec, index);
  if (!cell) return fail(cell.error());
  auto search = search_of(*cell, spec);
  if (!search) return fail(search.error());
  const TrialKey key{index, 0};
  return std::make_unique<HiddenEffectTrials>(std::move(*cell), *search, spec.trial_seed(key), key);
}

}  // namespace

const TrialStudy kTrialStudy{"hidden_effect", &prepare};

}  // namespace fatmc::hidden_effect
