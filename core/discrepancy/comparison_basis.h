// What depends on model and experiment alone, computed once and shared by every diagnosis of such a record: the law of its
// features where the model is right, the signatures of the effects, and how large each statistic becomes by chance.
//
// Chance is measured on flights that the law has not seen: the flights are split into kFolds parts, and each part is judged
// by the law of the others. So thresholds need no assumption on the law's form.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "core/discrepancy/dictionary.h"
#include "core/discrepancy/null_law.h"
#include "core/discrepancy/response_map.h"

namespace fatmc {

/// A change of the features by one standard deviation of something that neither model nor record states.
struct Nuisance {
  Effect effect;       ///< flown at these values ...
  double scale = 1.0;  ///< ... its change times this is one standard deviation
};

struct BasisOptions {
  int flights = 1000;
  std::vector<std::string> excluded;  ///< effects that are no candidates, by id or name
  std::vector<Nuisance> nuisances;
  int threads = 1;
};

/// Neighbouring features that one local statistic sums up: an unknown effect may be strong in a few of them only.
struct FeatureGroup {
  FeatureKind kind = FeatureKind::line;
  int channel = 0;
  double low_hz = 0.0, high_hz = 0.0;
  std::vector<int> rows;  ///< of the feature vector
};
std::vector<FeatureGroup> feature_groups(const FeatureLayout& layout);
/// Sum of squares of a white vector over every group.
Eigen::VectorXd group_sums(const std::vector<FeatureGroup>& groups,
                           const Eigen::Ref<const Eigen::VectorXd>& z);
/// Deviation of every group's sum over flights (rows), not below that of a square of unit variance, 2^(1/2): features with
/// a floor hardly scatter.
Eigen::VectorXd floored_deviation(const Eigen::Ref<const Eigen::MatrixXd>& sums,
                                  const Eigen::Ref<const Eigen::VectorXd>& mean);

/// Statistics of white vectors judged by laws that they did not shape.
struct NullStatistics {
  Eigen::MatrixXd score;   ///< flights x atoms: a^T z / |a|; zero for signatures that vanish
  Eigen::VectorXd energy;  ///< z^T z
  Eigen::VectorXd group_mean, group_deviation;  ///< of every group's sum of squares
  Eigen::VectorXd group_score;  ///< a flight: largest (sum - mean) / deviation over the groups
};

struct ComparisonBasis {
  /// kPaired: flights of the model whose features are kept, so that flights with effects and the same noise can be set
  /// against them; kBaseline: as many as a mean change is usually taken over.
  static constexpr int kFolds = 4, kBaseline = 8, kPaired = 200;

  FeatureLayout layout;
  std::vector<FeatureGroup> groups;
  NullLaw law;
  Eigen::MatrixXd baseline;        ///< features of the model's flights 0 ... kPaired-1, a column each
  Eigen::MatrixXd white_baseline;  ///< the same less the mean, whitened
  Eigen::VectorXd
      baseline_variance;  ///< of every group, mean over its features: 1, less where a floor stands for it
  Dictionary dictionary;
  Eigen::MatrixXd atoms;          ///< signatures, whitened by the law
  Eigen::MatrixXd atom_products;  ///< atoms^T atoms
  /// Flexible modes on a fine grid (resonance.h): effect, index of its variant, white signature.
  std::vector<Atom> resonances;
  Eigen::MatrixXd resonance_atoms;
  /// What higher_moments() (moment_filters.h) change, a column each; zero where one cannot be flown. No candidates: the probe
  /// of level_probe.h reads them.
  Eigen::MatrixXd moment_differences, moment_atoms;  ///< the latter whitened
  NullStatistics null;
  ResponseMap map;

  /// Fills what follows from law, dictionary and layout alone.
  void complete();
  /// `progress` counts flights over all stages.
  static Result<ComparisonBasis> make(const ModelSimulator& model, const LpmGrid& grid,
                                      const BasisOptions& options, const FlightProgress& progress = {});
};

}  // namespace fatmc
