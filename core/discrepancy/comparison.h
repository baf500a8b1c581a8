// One or several records set beside the model, in white coordinates: where the model is right, the discrepancy is a vector
// of independent normal variables of variance one. Records are stacked; an effect acts on all of them at once.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "core/discrepancy/comparison_basis.h"
#include "core/discrepancy/effect_curve.h"

namespace fatmc {

/// A record's features and what they are compared with. Pointers must outlive the comparison.
struct ComparedRecord {
  const ModelSimulator* model = nullptr;
  const ComparisonBasis* basis = nullptr;
  Eigen::VectorXd features;
};

/// What each statistic exceeds by chance with the probability that stands behind it, in a record on which the model is
/// right. Together below 1 %.
struct Thresholds {
  static constexpr double kScanShare = 0.004, kEnergyShare = 0.002, kLocalShare = 0.002;
  double scan = 0.0;         ///< of the largest generalised likelihood ratio over all signatures
  double energy = 0.0;       ///< of z^T z
  double local = 0.0;        ///< of the largest group score
  double energy_mean = 0.0;  ///< mean of z^T z: the noise floor
};

/// x with P(X > x) = share, from draws of X: the empirical quantile at 5 %, beyond it an exponential tail with the mean
/// excess over that quantile. Tails of chi-square are lighter, so that the share is kept from above.
double tail_quantile(std::vector<double> draws, double share);

class Comparison {
 public:
  explicit Comparison(std::vector<ComparedRecord> records, int threads);

  [[nodiscard]] const std::vector<ComparedRecord>& records() const { return records_; }
  [[nodiscard]] const Thresholds& thresholds() const { return thresholds_; }
  [[nodiscard]] Eigen::Index size() const { return discrepancy_.size(); }
  [[nodiscard]] const Dictionary& dictionary() const { return records_.front().basis->dictionary; }
  /// Record minus model, white.
  [[nodiscard]] const Eigen::VectorXd& discrepancy() const { return discrepancy_; }
  /// Signatures, white, a column each; scaled to nothing.
  [[nodiscard]] const Eigen::MatrixXd& atoms() const { return atoms_; }
  /// atoms()^T atoms().
  [[nodiscard]] Eigen::MatrixXd atom_products() const;
  /// Changes along the sizes of the candidates with one parameter.
  [[nodiscard]] const std::vector<EffectCurve>& curves() const { return curves_; }
  /// Flexible modes on a fine grid, and their white signatures.
  [[nodiscard]] const std::vector<Atom>& resonances() const { return records_.front().basis->resonances; }
  [[nodiscard]] const Eigen::MatrixXd& resonance_atoms() const { return resonance_atoms_; }
  /// White changes by higher_moments() (moment_filters.h), a column each; zero where one cannot be flown on every record.
  [[nodiscard]] const Eigen::MatrixXd& moment_atoms() const { return moment_atoms_; }

  /// Mean change of the features by each set of effects, white, a column each, from `flights` flights with the baseline's
  /// noise: over those that do not leave the model, since the record did not; a set of which half cannot be flown on a record
  /// is a column of NaN.
  [[nodiscard]] Eigen::MatrixXd changes(std::span<const std::vector<Effect>> sets, int flights) const;
  /// Largest standardised sum of squares over all groups of all records; `excess`: what the sums are larger by in the mean,
  /// the records' groups one after the other, or empty.
  [[nodiscard]] double local_score(const Eigen::Ref<const Eigen::VectorXd>& z,
                                   const Eigen::Ref<const Eigen::VectorXd>& excess = Eigen::VectorXd()) const;
  /// Rows that are held back where no record is: every fifth line.
  [[nodiscard]] std::vector<int> held_out_rows() const;
  [[nodiscard]] std::vector<int> training_rows() const;
  /// First row of a record in the stack.
  [[nodiscard]] Eigen::Index first_row(std::size_t record) const { return first_[record]; }
  /// First group of a record in the list of all groups, and their number.
  [[nodiscard]] Eigen::Index first_group(std::size_t record) const;
  [[nodiscard]] Eigen::Index group_count() const { return first_group(records_.size()); }
  /// First of `count` flights of a record that are set against those of the model with the same noise: others for every record,
  /// since records that share a reference share its flights.
  [[nodiscard]] int first_flight(std::size_t record, int count) const {
    return static_cast<int>(record) * count % (ComparisonBasis::kPaired - count);
  }
  /// Flights of the model, white, a column each; every record's are shifted against those of the others.
  [[nodiscard]] const Eigen::MatrixXd& white_baseline() const { return white_baseline_; }
  [[nodiscard]] int threads() const { return threads_; }

 private:
  std::vector<ComparedRecord> records_;
  int threads_;
  std::vector<Eigen::Index> first_;
  Eigen::VectorXd discrepancy_;
  Eigen::MatrixXd atoms_, resonance_atoms_, moment_atoms_, white_baseline_;
  std::vector<EffectCurve> curves_;
  Thresholds thresholds_;
};

}  // namespace fatmc
