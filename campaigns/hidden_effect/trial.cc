#include "campaigns/hidden_effect/trial.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>

#include "campaigns/flown/flown_cell.h"
#include "campaigns/hidden_effect/hidden_cell.h"
#include "campaigns/hidden_effect/hidden_draw.h"
#include "campaigns/hidden_effect/row_metrics.h"
#include "core/discrepancy/diagnosis.h"
#include "core/discrepancy/effect_size.h"

namespace fatmc::hidden_effect {
namespace {

/// What all cells with one model, experiment and set of nuisances share.
struct Search {
  std::unique_ptr<ModelSimulator> model;
  ComparisonBasis basis;
};

double number_of(const Effect& effect) {
  static const std::vector<Effect> all = effect_variants();
  const auto at =
      std::find_if(all.begin(), all.end(), [&](const Effect& e) { return e.name() == effect.name(); });
  return static_cast<double>(at - all.begin());
}

class HiddenEffectTrials final : public PreparedCell {
 public:
  HiddenEffectTrials(HiddenCell cell, std::shared_ptr<const Search> search, TrialSeed seed, TrialKey key)
      : cell_(std::move(cell)), search_(std::move(search)), seed_(seed), key_(key) {}

  TrialRow run(std::uint64_t repetition) const override {
    TrialRow row;
    row.key = {key_.cell, repetition};
    TrialSeed seed = seed_;
    seed.repetition = repetition;
    RandomStream random(seed, "hidden");
    const Drawn drawn = draw(cell_.tier, random);
    for (std::size_t i = 0; i < std::size(kHidden); ++i) {
      row.metrics.emplace_back(kHidden[i], i < drawn.effects.size() ? number_of(drawn.effects[i]) : -1.0);
    }
    const auto seen = features(drawn, seed, "record", row);
    const auto scoring = features(drawn, seed, "scoring", row);
    if (!seen || !scoring) return row;

    const Comparison comparison({{search_->model.get(), &search_->basis, *seen}}, 1);
    DiagnosisOptions options;
    if (cell_.taken_out) {
      for (const Effect& e : drawn.effects) options.excluded.push_back(e.id);
    }
    const Diagnosis diagnosis = diagnose(comparison, nullptr, options);
    score(drawn, diagnosis, row);
    score_gap(*scoring, diagnosis, row);
    return row;
  }

 private:
  /// Features of a flight with what was drawn; its noise is that of the trial's own stream `purpose`.
  std::optional<Eigen::VectorXd> features(const Drawn& drawn, TrialSeed seed, std::string_view purpose,
                                          TrialRow& row) const {
    const ModelSimulator& model = *search_->model;
    std::vector<Effect> all = drawn.errors;
    all.insert(all.end(), drawn.effects.begin(), drawn.effects.end());
    const auto stop = [&](std::string detail) {
      row.outcome = "diverged";
      row.detail = std::move(detail);
      return std::nullopt;
    };
    const auto modified = apply(model.aircraft(), model.setup(), all);
    if (!modified) return stop(modified.error().text());
    const auto flight = Flight::prepare(modified->aircraft, modified->setup);
    if (!flight) return stop(flight.error().text());
    seed.study ^= name_hash(purpose);
    FlightRecord flown;
    flight->fly(model.reference(), seed, flown);
    if (flown.ending != Ending::completed) return stop(std::string(name(flown.ending)));
    return model.extractor().extract(
        {flown.reference, flown.input, flown.output, flown.auxiliary.leftCols(2), flown.auxiliary.col(2)});
  }

  /// Whether the two count as one: equal names, or together in a class that the spec declares.
  [[nodiscard]] bool same(const Effect& a, const Effect& b) const {
    if (a.name() == b.name()) return true;
    return std::any_of(cell_.classes.begin(), cell_.classes.end(),
                       [&](const std::vector<std::string>& members) {
                         const auto in = [&](const Effect& e) {
                           return std::find(members.begin(), members.end(), e.name()) != members.end();
                         };
                         return in(a) && in(b);
                       });
  }

  void score(const Drawn& drawn, const Diagnosis& d, TrialRow& row) const {
    const auto in = [&](const Effect& e, const std::vector<Effect>& list) {
      return std::any_of(list.begin(), list.end(), [&](const Effect& other) { return same(e, other); });
    };
    const std::vector<Effect> named = d.verdict == Verdict::unknown ? std::vector<Effect>{} : d.effect_list();
    double right = 0.0, spurious = 0.0;
    for (const Effect& e : drawn.effects) right += in(e, named) ? 1.0 : 0.0;
    for (const Effect& e : named) spurious += in(e, drawn.effects) || in(e, drawn.errors) ? 0.0 : 1.0;
    row.metrics.emplace_back(kVerdict, static_cast<double>(d.verdict));
    row.metrics.emplace_back(kNamedCount, static_cast<double>(named.size()));
    for (std::size_t i = 0; i < std::size(kNamed); ++i) {
      row.metrics.emplace_back(kNamed[i], i < named.size() ? number_of(named[i]) : -1.0);
    }
    row.metrics.emplace_back(kRightCount, right);
    row.metrics.emplace_back(kSpurious, spurious);
    row.metrics.emplace_back(kScan, d.evidence.scan);
    row.metrics.emplace_back(kClassSize, std::max<double>(1.0, static_cast<double>(d.members.size())));
    if (drawn.effects.empty()) return;
    const Effect& first = drawn.effects.front();
    row.metrics.emplace_back(kClassHolds, in(first, named) || in(first, d.members) ? 1.0 : 0.0);
    for (const FoundEffect& found : d.effects) {
      if (found.effect.name() != first.name() || d.verdict == Verdict::unknown) continue;
      const EffectParameter& p = first.kind().parameters.front();
      const double truth = to_natural(p, first.values.front()),
                   size = std::abs(truth - to_natural(p, p.nominal));
      const ParameterEstimate& estimate = found.parameters.front();
      row.metrics.emplace_back(kParameterError, std::abs(to_natural(p, estimate.value) - truth) / size);
      row.metrics.emplace_back(
          kCovered,
          estimate.low <= first.values.front() && first.values.front() <= estimate.high ? 1.0 : 0.0);
    }
  }

  void score_gap(const Eigen::VectorXd& scoring, const Diagnosis& d, TrialRow& row) const {
    const Comparison unseen({{search_->model.get(), &search_->basis, scoring}}, 1);
    const double floor = unseen.thresholds().energy_mean, before = unseen.discrepancy().squaredNorm();
    if (d.effects.empty() || before < unseen.thresholds().energy) return;
    const std::vector<std::vector<Effect>> sets = {d.effect_list()};
    const double after =
        (unseen.discrepancy() - unseen.changes(sets, ComparisonBasis::kBaseline).col(0)).squaredNorm();
    if (std::isfinite(after))
      row.metrics.emplace_back(kGapLeft, std::max(0.0, (after - floor) / (before - floor)));
  }

  HiddenCell cell_;
  std::shared_ptr<const Search> search_;
  TrialSeed seed_;
  TrialKey key_;
};

Result<std::shared_ptr<const Search>> make_search(const HiddenCell& cell, const CampaignSpec& spec) {
  const Excitation& excitation = cell.flown.experiment.excitation;
  const FlightSetup& setup = cell.flown.experiment.flight;
  const PeriodicExperiment experiment{excitation.lines, excitation.period_samples, excitation.periods,
                                      setup.rate_hz};
  auto layout = FeatureLayout::create(experiment, true, true, setup.closed_loop);
  if (!layout) return fail(layout.error());
  auto grid = LpmGrid::create(experiment, {}, 3);
  if (!grid) return fail(grid.error());
  // Phases are those of the campaign: one excitation for all its trials.
  const TrialSeed phases{spec.seed, name_hash("hidden_effect"), name_hash("excitation"), 0};
  auto out = std::make_shared<Search>();
  out->model = std::make_unique<ModelSimulator>(cell.flown.model.aircraft, setup, cell.flown.model.effects,
                                                reference_signal(cell.flown.experiment, phases),
                                                FeatureExtractor(*layout, setup.gain));
  BasisOptions options;
  options.flights = cell.null_flights;
  if (cell.tier.turbulence_error > 0.0) {
    auto level = parse_effect("turbulence:factor=1.2");
    if (!level) return fail(level.error());
    options.nuisances.push_back({*level, cell.tier.turbulence_error / std::log(1.2)});
    options.excluded.emplace_back("turbulence");
  }
  auto basis = ComparisonBasis::make(*out->model, *grid, options);
  if (!basis) return fail(basis.error());
  out->basis = std::move(*basis);
  return std::shared_ptr<const Search>(std::move(out));
}

/// Cells that differ in what they hide alone share a search; it is made once a process.
Result<std::shared_ptr<const Search>> search_of(const HiddenCell& cell, const CampaignSpec& spec) {
  static std::mutex mutex;
  static std::map<std::string, std::shared_ptr<const Search>> known;
  const std::lock_guard lock(mutex);
  auto& place = known[cell.search_key];
  if (place != nullptr) return place;
  auto made = make_search(cell, spec);
  if (!made) return fail(made.error());
  return place = *made;
}

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
