#include "campaigns/hidden_effect/hidden_search.h"

#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <map>

#include "campaigns/base/trial_row.h"
#include "core/base/build_hash.h"
#include "core/base/text.h"
#include "core/discrepancy/basis_cache.h"
#include "core/discrepancy/moment_filters.h"

namespace fatmc::hidden_effect {
namespace {

/// Empty: nowhere.
std::string cache_folder() {
  const auto variable = [](const char* name) -> std::optional<std::string> {
    const char* value = std::getenv(name);
    return value == nullptr ? std::nullopt : std::optional<std::string>(value);
  };
  std::string folder;
  if (const auto own = variable("FATMC_CACHE")) {
    folder = *own;
  } else if (const auto cache = variable("XDG_CACHE_HOME"); cache && !cache->empty()) {
    folder = *cache + "/fatmc";
  } else if (const auto home = variable("HOME"); home && !home->empty()) {
    folder = *home + "/.cache/fatmc";
  }
  if (folder.empty()) return folder;
  char host[256] = {};
  if (gethostname(host, sizeof host - 1) != 0) return {};
  return folder + "/" + host;
}

std::string key_of(const HiddenCell& cell, const ModelSimulator& model, const BasisOptions& options) {
  std::string text = build_hash() + "\n" + cell.search_key + "\n" + join(options.excluded) + "\n";
  for (const Nuisance& n : options.nuisances) text += n.effect.text() + " " + shortest(n.scale) + "\n";
  const Eigen::MatrixX3d& reference = model.reference();
  text.append(reinterpret_cast<const char*>(reference.data()),
              static_cast<std::size_t>(reference.size()) * sizeof(double));
  return hex(sha256(text));
}

}  // namespace

Result<std::unique_ptr<HiddenSearch>> HiddenSearch::create(const HiddenCell& cell, const CampaignSpec& spec) {
  auto out = std::make_unique<HiddenSearch>();
  const FlightSetup& setup = cell.flown.experiment.flight;
  // Phases are those of the campaign: one excitation for all its trials.
  const TrialSeed phases{spec.seed, name_hash("hidden_effect"), name_hash("excitation"), 0};
  for (const double level : cell.tier.levels) {
    Experiment experiment = cell.flown.experiment;
    for (double& a : experiment.excitation.amplitude_rad_s) a *= level;
    const Excitation& excitation = experiment.excitation;
    const PeriodicExperiment periodic{excitation.lines, excitation.period_samples, excitation.periods,
                                      setup.rate_hz};
    auto layout = FeatureLayout::create(periodic, true, true, setup.closed_loop);
    if (!layout) return fail(layout.error());
    auto grid = LpmGrid::create(periodic, {}, 3);
    if (!grid) return fail(grid.error());
    SearchLevel made;
    made.model = std::make_unique<ModelSimulator>(
        with_moment_filters({cell.flown.model.aircraft, setup, cell.flown.model.effects,
                             reference_signal(experiment, phases), FeatureExtractor(*layout, setup.gain)}));
    if (const auto once = made.model->record({}, 0); !once) {
      Error error = once.error();
      if (error.key.empty()) error.message = "the model does not survive the experiment: " + error.message;
      return fail(locate_flight_error(error, *spec.tree.find("model"), *spec.tree.find("experiment")));
    }
    BasisOptions options;
    options.flights = cell.null_flights;
    if (const double error = cell.tier.draw.turbulence_error; error > 0.0) {
      auto changed = parse_effect("turbulence:factor=1.2");
      if (!changed) return fail(changed.error());
      options.nuisances.push_back({*changed, error / std::log(1.2)});
      options.excluded.emplace_back("turbulence");
    }
    const std::string key = key_of(cell, *made.model, options);
    out->recipes_.push_back({std::move(*grid), std::move(options), key});
    out->levels_.push_back(std::move(made));
  }
  return out;
}

Result<const std::vector<SearchLevel>*> HiddenSearch::prepared() const {
  std::call_once(once_, [&] {
    const std::string folder = cache_folder();
    for (std::size_t i = 0; i < levels_.size() && !error_; ++i) {
      const Recipe& recipe = recipes_[i];
      const ModelSimulator& model = *levels_[i].model;
      auto basis = cached_basis({folder, recipe.key}, model.extractor().layout(), recipe.grid, recipe.options,
                                [&] { return ComparisonBasis::make(model, recipe.grid, recipe.options); });
      if (basis) {
        levels_[i].basis = std::move(basis->basis);
      } else {
        error_ = basis.error();
      }
    }
  });
  if (error_) return fail(*error_);
  return &levels_;
}

Result<std::shared_ptr<const HiddenSearch>> search_of(const HiddenCell& cell, const CampaignSpec& spec) {
  static std::mutex mutex;
  static std::map<std::string, std::shared_ptr<const HiddenSearch>> known;
  std::string key = cell.search_key;
  for (const double level : cell.tier.levels) key += " " + shortest(level);
  const std::lock_guard lock(mutex);
  auto& place = known[key];
  if (place != nullptr) return place;
  auto made = HiddenSearch::create(cell, spec);
  if (!made) return fail(made.error());
  place = std::shared_ptr<const HiddenSearch>(std::move(*made));
  return place;
}

}  // namespace fatmc::hidden_effect
