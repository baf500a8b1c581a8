#include "coordinator/cli/diagnosis_run.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <sstream>
#include <thread>

#include "core/base/text.h"
#include "core/discrepancy/basis_cache.h"
#include "core/discrepancy/effect_size.h"

namespace fatmc::cli {
namespace {

constexpr int kMeanFlights = 8, kMostRounds = 4;

/// "learning what chance gives: 320/1612 flights", redrawn on a terminal, else a line at every tenth.
FlightProgress flight_progress() {
  const bool terminal = isatty(STDERR_FILENO) != 0;
  return [terminal, last = -1](int done, int total) mutable {
    const int tenth = 10 * done / std::max(1, total);
    if (terminal) {
      if (done % 16 == 0 || done == total)
        std::fprintf(stderr, "\rlearning what chance gives: %d/%d flights", done, total);
      if (done == total) std::fprintf(stderr, "\n");
    } else if (tenth != last) {
      last = tenth;
      std::fprintf(stderr, "learning what chance gives: %d/%d flights\n", done, total);
    }
  };
}

/// The basis from the cache, or made and put there. A cache that cannot be written is no reason to fail.
Result<ComparisonBasis> basis_of(const PreparedRecord& record, const DiagnosedModel& model,
                                 const std::string& cache) {
  auto found = cached_basis(
      {cache, basis_key(record, model)}, record.model->extractor().layout(), record.grid, record.basis,
      [&] { return ComparisonBasis::make(*record.model, record.grid, record.basis, flight_progress()); });
  if (!found) return fail(found.error());
  if (!found->trouble.empty()) {
    std::fprintf(stderr, "fatmc: the basis is not kept for the next diagnosis: %s\n", found->trouble.c_str());
  }
  return std::move(found->basis);
}

/// Records with their bases, ready to be compared. Pointers stay valid while this lives.
struct Stack {
  std::vector<std::unique_ptr<PreparedRecord>> prepared;
  std::vector<std::unique_ptr<ComparisonBasis>> bases;
  [[nodiscard]] std::vector<ComparedRecord> compared() const {
    std::vector<ComparedRecord> out;
    for (std::size_t i = 0; i < prepared.size(); ++i) {
      out.push_back({prepared[i]->model.get(), bases[i].get(), prepared[i]->features});
    }
    return out;
  }
};

Result<Stack> prepare_stack(const std::vector<DiagnosedRecord*>& records, const DiagnosedModel& model,
                            const std::vector<Effect>& effects, const DiagnosisRunOptions& options,
                            int threads, bool turbulence_excluded) {
  Stack out;
  for (DiagnosedRecord* record : records) {
    auto prepared = prepare_record(*record, model, effects, threads);
    if (!prepared) return fail(prepared.error());
    prepared->basis.flights = options.flights;
    auto& excluded = prepared->basis.excluded;
    excluded.insert(excluded.end(), options.excluded.begin(), options.excluded.end());
    if (turbulence_excluded) excluded.emplace_back("turbulence");
    std::sort(excluded.begin(), excluded.end());
    excluded.erase(std::unique(excluded.begin(), excluded.end()), excluded.end());
    auto basis = basis_of(*prepared, model, options.cache);
    if (!basis) {
      Error error = basis.error();
      if (error.file.empty()) error.file = record->path;
      return fail(error);
    }
    out.bases.push_back(std::make_unique<ComparisonBasis>(std::move(*basis)));
    out.prepared.push_back(std::make_unique<PreparedRecord>(std::move(*prepared)));
  }
  return out;
}

/// Places beyond chance, the largest sigma first: cells of the map, then means, spectra and the rest.
std::vector<Place> places_of(const Comparison& comparison, const std::vector<MapEntry>& map) {
  constexpr const char* kInputs[] = {"xi_c", "eta_c", "zeta_c"};
  constexpr const char* kOutputs[] = {"p", "q", "r"};
  std::vector<Place> out;
  for (const MapEntry& e : map) {
    if (!e.significant()) continue;
    out.push_back(
        {kOutputs[e.cell.output], kInputs[e.cell.input], e.low_hz, e.high_hz, e.decibel, e.degrees, e.sigma});
  }
  const ComparisonBasis& basis = *comparison.records().front().basis;
  const Eigen::VectorXd z = comparison.discrepancy().head(basis.layout.size);
  const Eigen::VectorXd raw = comparison.records().front().features - basis.law.mean;
  for (std::size_t g = 0; g < basis.groups.size(); ++g) {
    const FeatureGroup& group = basis.groups[g];
    if (group.kind == FeatureKind::line || group.rows.size() != 1) continue;
    const double value = std::abs(z[group.rows.front()]);
    const auto at = static_cast<Eigen::Index>(g);
    const double score = (value * value - basis.null.group_mean[at]) / basis.null.group_deviation[at];
    if (score <= comparison.thresholds().local) continue;
    const bool power = group.kind == FeatureKind::noise || group.kind == FeatureKind::distortion ||
                       group.kind == FeatureKind::peak;
    const double decibel = power ? 10.0 / std::log(10.0) * raw[group.rows.front()] : 0.0;
    out.push_back({basis.layout.channel_name(group.channel), std::string(name(group.kind)), group.low_hz,
                   group.high_hz, decibel, 0.0, value});
  }
  std::stable_sort(out.begin(), out.end(), [](const Place& a, const Place& b) { return a.sigma > b.sigma; });
  return out;
}

/// What the records could not have shown: candidates whose largest moderate size stays below the threshold.
void note_invisible(const Comparison& comparison, Diagnosis& diagnosis) {
  const Dictionary& dictionary = comparison.dictionary();
  std::vector<double> most(dictionary.variants.size(), 0.0);
  for (std::size_t a = 0; a < dictionary.atoms.size(); ++a) {
    double& own = most[static_cast<std::size_t>(dictionary.atoms[a].variant)];
    own = std::max(own, comparison.atoms().col(static_cast<Eigen::Index>(a)).squaredNorm());
  }
  std::vector<std::string> names;
  for (std::size_t v = 0; v < most.size(); ++v) {
    if (most[v] < comparison.thresholds().scan) names.push_back(dictionary.variants[v].name());
  }
  if (names.empty()) return;
  const bool noisy = 2 * names.size() > most.size();
  diagnosis.notes.push_back(
      std::string(noisy ? "The records are too noisy or too short to decide: they would not show even"
                        : "These records would not show") +
      " a moderate size of " + join(names) + ".");
}

struct Measured {
  MeasuredGap gap;
  ResponseOverlay overlay;
};

Result<Measured> measure(const DiagnosedRecord& record, const PreparedRecord& prepared,
                         const ComparisonBasis& basis, const std::vector<Effect>& effects, bool holdout) {
  auto before = mean_flight(*prepared.model, prepared.grid, {}, 0, kMeanFlights);
  if (!before) return fail(before.error());
  auto after = mean_flight(*prepared.model, prepared.grid, effects, 0, kMeanFlights);
  if (!after) return fail(after.error());
  auto other = mean_flight(*prepared.model, prepared.grid, effects, kMeanFlights, 1);
  if (!other) return fail(other.error());
  FastLpm estimator(prepared.grid, 3);
  const Eigen::VectorXcd response = response_vector(estimator, record.record, record.setup.closed_loop);
  Measured out;
  std::vector<double> f;
  for (int k = 0; k < prepared.grid.line_count(); ++k) f.push_back(prepared.grid.frequency_hz(k));
  out.gap = {record.path, holdout, measure_gap(f, response, record.record.output, *before),
             measure_gap(f, response, record.record.output, *after),
             measure_gap(f, other->response, other->output, *after)};
  out.overlay = {
      record.path, holdout, f, response, before->response, after->response, basis.map.variance().cwiseSqrt()};
  return out;
}

}  // namespace

std::string read_file_bytes(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

Result<DiagnosisRun> run_diagnosis(const std::string& model_path, const std::vector<std::string>& records,
                                   const std::vector<std::string>& holdout,
                                   const DiagnosisRunOptions& options) {
  const int threads = options.threads > 0
                          ? options.threads
                          : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  DiagnosisRun out;
  auto model = read_diagnosed_model(model_path);
  if (!model) return fail(model.error());
  out.model = std::make_unique<DiagnosedModel>(std::move(*model));
  std::vector<DiagnosedRecord*> training, held;
  bool turbulence_excluded = false;
  for (const bool is_holdout : {false, true}) {
    for (const std::string& path : is_holdout ? holdout : records) {
      auto record = read_diagnosed_record(path, *out.model);
      if (!record) return fail(record.error());
      turbulence_excluded = turbulence_excluded || !record->turbulence_stated;
      out.records.push_back(std::make_unique<DiagnosedRecord>(std::move(*record)));
      (is_holdout ? held : training).push_back(out.records.back().get());
    }
  }
  DiagnosisPage& page = out.page;
  page.model = out.model.get();
  page.records.assign(training.begin(), training.end());
  page.holdout.assign(held.begin(), held.end());

  std::vector<Effect> found;
  for (int round = 0; round < kMostRounds; ++round) {
    auto stack = prepare_stack(training, *out.model, found, options, threads, turbulence_excluded);
    if (!stack) return fail(stack.error());
    auto held_stack = prepare_stack(held, *out.model, found, options, threads, turbulence_excluded);
    if (!held_stack) return fail(held_stack.error());
    const Comparison comparison(stack->compared(), threads);
    std::unique_ptr<Comparison> held_comparison;
    if (!held.empty()) held_comparison = std::make_unique<Comparison>(held_stack->compared(), threads);
    DiagnosisOptions search;
    // What no one states is estimated with the effects.
    const DiagnosedRecord& front = *training.front();
    if (!front.turbulence_stated && front.setup.turbulence_m_s > 0.0)
      search.nuisances.push_back(*nominal_effect("turbulence", {}));
    Diagnosis diagnosis = diagnose(comparison, held_comparison.get(), search);
    if (round == 0) {
      FastLpm estimator(stack->prepared.front()->grid, 3);
      const ResponseMap& map = stack->bases.front()->map;
      out.map =
          map.read(response_vector(estimator, training.front()->record, training.front()->setup.closed_loop));
      page.where = places_of(comparison, out.map);
      page.thresholds = comparison.thresholds();
      page.diagnosis = diagnosis;
      for (const DiagnosedRecord* r : page.records) {
        for (const std::string& a : r->assumptions) page.diagnosis.notes.push_back(r->path + ": " + a);
        if (!r->turbulence_stated) {
          page.diagnosis.notes.push_back(r->path + ": no one states the turbulence; " +
                                         significant(r->setup.turbulence_m_s, 3) +
                                         " m/s is estimated from the noise and not named as an effect.");
        }
      }
      if (training.size() == 1) {
        page.diagnosis.notes.emplace_back(
            "One record at one level and speed: whether a value depends on speed, it cannot tell; on level, "
            "only by what a quadratic or cubic moment leaves on harmonics that are not excited.");
      }
      note_invisible(comparison, page.diagnosis);
      if (options.separability) out.separations = separations(comparison);
      for (const bool is_holdout : {false, true}) {
        const auto& own = is_holdout ? held : training;
        const Stack& from = is_holdout ? *held_stack : *stack;
        for (std::size_t i = 0; i < own.size(); ++i) {
          auto measured =
              measure(*own[i], *from.prepared[i], *from.bases[i], diagnosis.effect_list(), is_holdout);
          if (!measured)
            continue;  // a partial explanation that cannot be flown on this record has no measures
          page.gaps.push_back(std::move(measured->gap));
          out.overlays.push_back(std::move(measured->overlay));
        }
      }
    } else {
      // A later round speaks of what is left; what has been found before stays.
      page.earlier.insert(page.earlier.end(), page.diagnosis.effects.begin(), page.diagnosis.effects.end());
      page.diagnosis.effects = diagnosis.effects;
      page.diagnosis.notes.insert(page.diagnosis.notes.end(), diagnosis.notes.begin(), diagnosis.notes.end());
      page.diagnosis.verdict = diagnosis.verdict;
      page.diagnosis.members = diagnosis.members;
      page.diagnosis.separate_by = diagnosis.separate_by;
      page.diagnosis.training.after = diagnosis.training.after;
      page.diagnosis.holdout.after = diagnosis.holdout.after;
    }
    if (!options.until_consistent || diagnosis.verdict != Verdict::named) break;
    for (const FoundEffect& f : diagnosis.effects) found.push_back(f.effect);
    std::fprintf(stderr, "round %d: %s; once more with it in the model\n", round + 1,
                 found.back().text().c_str());
  }
  return out;
}

}  // namespace fatmc::cli
