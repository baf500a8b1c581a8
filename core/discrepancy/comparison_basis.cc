#include "core/discrepancy/comparison_basis.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <mutex>

#include "core/base/check.h"
#include "core/discrepancy/moment_filters.h"
#include "core/discrepancy/resonance.h"
#include "core/ident/fast_lpm.h"

namespace fatmc {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

/// Estimators that threads take and give back: each owns a workspace.
class EstimatorPool {
 public:
  explicit EstimatorPool(const LpmGrid& grid) : grid_(grid) {}
  std::unique_ptr<FastLpm> take() {
    const std::lock_guard lock(mutex_);
    if (idle_.empty()) return std::make_unique<FastLpm>(grid_, 3);
    std::unique_ptr<FastLpm> out = std::move(idle_.back());
    idle_.pop_back();
    return out;
  }
  void give_back(std::unique_ptr<FastLpm> one) {
    const std::lock_guard lock(mutex_);
    idle_.push_back(std::move(one));
  }

 private:
  const LpmGrid& grid_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<FastLpm>> idle_;
};

/// Features and responses of the model's own flights, a row a flight.
struct NullFlights {
  Matrix features;
  Eigen::MatrixXcd responses;
};

Result<NullFlights> fly_null(const ModelSimulator& model, const LpmGrid& grid, const BasisOptions& options,
                             const FlightProgress& progress) {
  NullFlights out;
  out.features.resize(options.flights, model.extractor().layout().size);
  out.responses.resize(options.flights, 9 * grid.line_count());
  EstimatorPool estimators(grid);
  const Status flown = model.visit_null(
      options.flights, options.threads,
      [&](int n, const LoopRecord& record) {
        out.features.row(n) = model.extractor().extract(record).transpose();
        std::unique_ptr<FastLpm> estimator = estimators.take();
        out.responses.row(n) = response_vector(*estimator, record, model.setup().closed_loop).transpose();
        estimators.give_back(std::move(estimator));
      },
      progress);
  if (!flown) return fail(flown.error());
  return out;
}

Matrix moment_changes(const ModelSimulator& model, const Matrix& baseline, int threads,
                      const FlightProgress& progress) {
  constexpr int kFlights = ComparisonBasis::kBaseline;
  std::vector<std::vector<Effect>> sets;
  for (const Effect& moment : higher_moments()) sets.push_back({moment});
  const std::vector<EffectFlights> flown = model.fly(sets, 0, kFlights, threads, progress);
  Matrix out = Matrix::Zero(baseline.rows(), static_cast<Eigen::Index>(sets.size()));
  for (std::size_t i = 0; i < flown.size(); ++i) {
    if (!flown[i].usable()) continue;
    out.col(static_cast<Eigen::Index>(i)) =
        (flown[i].features - baseline.leftCols(kFlights)).rowwise().mean();
  }
  return out;
}

/// Every flight judged by the law of the other folds.
NullStatistics cross_validate(const ComparisonBasis& basis, const Matrix& features,
                              const Matrix& uncertainty) {
  const Eigen::Index flights = features.rows();
  const auto atoms = basis.dictionary.differences.cols();
  NullStatistics out;
  out.score.setZero(flights, atoms);
  out.energy.resize(flights);
  Matrix sums(flights, static_cast<Eigen::Index>(basis.groups.size()));
  for (int fold = 0; fold < ComparisonBasis::kFolds; ++fold) {
    std::vector<int> seen, judged;
    for (int n = 0; n < flights; ++n) (n % ComparisonBasis::kFolds == fold ? judged : seen).push_back(n);
    NullLaw law = NullLaw::fit(basis.layout, features(seen, Eigen::all));
    law.add_uncertainty(basis.layout, uncertainty);
    const Matrix z =
        law.whiten(basis.layout, (features(judged, Eigen::all).rowwise() - law.mean.transpose()).transpose());
    const Matrix a = law.whiten(basis.layout, basis.dictionary.differences);
    const Vector norm = a.colwise().norm().transpose();
    const Matrix products = z.transpose() * a;
    for (std::size_t i = 0; i < judged.size(); ++i) {
      const auto at = static_cast<Eigen::Index>(i);
      for (Eigen::Index j = 0; j < atoms; ++j) {
        if (norm[j] > 0.0) out.score(judged[i], j) = products(at, j) / norm[j];
      }
      out.energy[judged[i]] = z.col(at).squaredNorm();
      sums.row(judged[i]) = group_sums(basis.groups, z.col(at)).transpose();
    }
  }
  out.group_mean = sums.colwise().mean().transpose();
  out.group_deviation = floored_deviation(sums, out.group_mean);
  const Matrix centred = sums.rowwise() - out.group_mean.transpose();
  out.group_score.resize(flights);
  for (Eigen::Index n = 0; n < flights; ++n) {
    out.group_score[n] = (centred.row(n).transpose().array() / out.group_deviation.array()).maxCoeff();
  }
  return out;
}

}  // namespace

Vector group_sums(const std::vector<FeatureGroup>& groups, const Eigen::Ref<const Vector>& z) {
  Vector out(static_cast<Eigen::Index>(groups.size()));
  for (std::size_t g = 0; g < groups.size(); ++g) {
    double sum = 0.0;
    for (const int row : groups[g].rows) sum += z[row] * z[row];
    out[static_cast<Eigen::Index>(g)] = sum;
  }
  return out;
}

Vector floored_deviation(const Eigen::Ref<const Matrix>& sums, const Eigen::Ref<const Vector>& mean) {
  const Matrix centred = sums.rowwise() - mean.transpose();
  return (centred.colwise().squaredNorm() / static_cast<double>(sums.rows() - 1))
      .cwiseSqrt()
      .cwiseMax(std::sqrt(2.0))
      .transpose();
}

std::vector<FeatureGroup> feature_groups(const FeatureLayout& layout) {
  std::vector<FeatureGroup> out;
  const int lines = static_cast<int>(layout.experiment.lines.size());
  const int bands = std::min(ResponseMap::kBands, lines);
  const auto responses = static_cast<int>(layout.blocks.front().channels.size());
  for (int c = 0; c < responses; ++c) {
    for (int b = 0; b < bands; ++b) {
      FeatureGroup group{FeatureKind::line, c, 0.0, 0.0, {}};
      for (int k = lines * b / bands; k < lines * (b + 1) / bands; ++k) {
        const FeatureBlock& block = layout.blocks[static_cast<std::size_t>(k)];
        if (group.rows.empty()) group.low_hz = block.low_hz;
        group.high_hz = block.high_hz;
        group.rows.insert(group.rows.end(), {block.first + c, block.first + responses + c});
      }
      out.push_back(std::move(group));
    }
  }
  for (const FeatureBlock& block : layout.blocks) {
    if (block.kind == FeatureKind::line) continue;
    for (std::size_t i = 0; i < block.channels.size(); ++i) {
      out.push_back(
          {block.kind, block.channels[i], block.low_hz, block.high_hz, {block.first + static_cast<int>(i)}});
    }
  }
  return out;
}

void ComparisonBasis::complete() {
  atoms = law.whiten(layout, dictionary.differences);
  atom_products.setZero(atoms.cols(), atoms.cols());
  atom_products.selfadjointView<Eigen::Lower>().rankUpdate(atoms.transpose());
  atom_products.triangularView<Eigen::StrictlyUpper>() = atom_products.transpose();
  moment_atoms = law.whiten(layout, moment_differences);
  white_baseline = law.whiten(layout, baseline.colwise() - law.mean);
  resonances.clear();
  std::vector<Matrix> parts;
  Eigen::Index count = 0;
  for (std::size_t a = 0; a < dictionary.atoms.size(); ++a) {
    const Atom& atom = dictionary.atoms[a];
    if (broad_resonance(atom.effect) != atom.effect) continue;
    ResonanceGrid grid =
        resonance_grid(layout, atom.effect, dictionary.differences.col(static_cast<Eigen::Index>(a)));
    for (Effect& effect : grid.effects) resonances.push_back({std::move(effect), atom.variant});
    parts.push_back(law.whiten(layout, grid.differences));
    count += parts.back().cols();
  }
  resonance_atoms.resize(layout.size, count);
  Eigen::Index first = 0;
  for (const Matrix& part : parts) {
    resonance_atoms.middleCols(first, part.cols()) = part;
    first += part.cols();
  }
}

Result<ComparisonBasis> ComparisonBasis::make(const ModelSimulator& model, const LpmGrid& grid,
                                              const BasisOptions& options, const FlightProgress& progress) {
  FATMC_CHECK(options.flights >= kPaired, "flights of the model are kept");
  ComparisonBasis out;
  out.layout = model.extractor().layout();
  out.groups = feature_groups(out.layout);
  const int signatures = static_cast<int>(signature_effects(candidate_variants(options.excluded)).size());
  const int nuisances = static_cast<int>(options.nuisances.size());
  const auto& moments = higher_moments();
  const int total = options.flights + signatures * Dictionary::kFlights +
                    (nuisances + static_cast<int>(moments.size())) * kBaseline;
  int before = 0;
  const FlightProgress stage = [&](int done, int) {
    if (progress) progress(before + done, total);
  };

  auto flown = fly_null(model, grid, options, stage);
  if (!flown) return fail(flown.error());
  before += options.flights;
  out.baseline = flown->features.topRows(kPaired).transpose();
  Matrix uncertainty(out.layout.size, nuisances);
  for (int i = 0; i < nuisances; ++i) {
    const Nuisance& nuisance = options.nuisances[static_cast<std::size_t>(i)];
    const std::vector<std::vector<Effect>> sets = {{nuisance.effect}};
    const EffectFlights changed = model.fly(sets, 0, kBaseline, options.threads, stage).front();
    if (!changed.usable()) return fail(nuisance.effect.text() + " cannot be flown: " + changed.failure);
    uncertainty.col(i) =
        nuisance.scale * (changed.features - out.baseline.leftCols(kBaseline)).rowwise().mean();
    before += kBaseline;
  }
  out.moment_differences = moment_changes(model, out.baseline, options.threads, stage);
  before += static_cast<int>(moments.size()) * kBaseline;
  out.dictionary = make_dictionary(model, options.excluded, out.baseline, options.threads, stage);
  out.law = NullLaw::fit(out.layout, flown->features);
  out.law.add_uncertainty(out.layout, uncertainty);
  out.complete();
  out.null = cross_validate(out, flown->features, uncertainty);
  out.map = ResponseMap::fit(grid, flown->responses);
  return out;
}

}  // namespace fatmc
