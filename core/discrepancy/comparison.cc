#include "core/discrepancy/comparison.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/check.h"
#include "core/stats/empirical.h"

namespace fatmc {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

constexpr int kHeldBack = 5;  // every fifth line
constexpr int kShift = 37;    // flights by which records are shifted against each other

bool held_out(const FeatureBlock& block) {
  return block.kind == FeatureKind::line && block.line % kHeldBack == 2;
}

/// Flights of the records combined: the n-th of each, which are independent where the references differ. Records that share
/// a reference share a basis and its flights; they are shifted against each other.
Thresholds combine(const std::vector<ComparedRecord>& records, const Matrix& atoms,
                   const std::vector<Eigen::Index>& first) {
  Eigen::Index flights = std::numeric_limits<Eigen::Index>::max();
  for (const ComparedRecord& r : records) flights = std::min(flights, r.basis->null.energy.size());
  Vector energy = Vector::Zero(flights), local = Vector::Constant(flights, -1e300);
  Matrix products = Matrix::Zero(flights, atoms.cols());
  const Vector norm = atoms.colwise().norm().transpose();
  for (std::size_t i = 0; i < records.size(); ++i) {
    const ComparisonBasis& basis = *records[i].basis;
    const Vector own = atoms.middleRows(first[i], basis.layout.size).colwise().norm().transpose();
    for (Eigen::Index n = 0; n < flights; ++n) {
      const Eigen::Index m = (n + static_cast<Eigen::Index>(i) * kShift) % flights;
      energy[n] += basis.null.energy[m];
      local[n] = std::max(local[n], basis.null.group_score[m]);
      products.row(n) += basis.null.score.row(m).cwiseProduct(own.transpose());
    }
  }
  std::vector<double> largest;
  for (Eigen::Index n = 0; n < flights; ++n) {
    double most = 0.0;
    for (Eigen::Index a = 0; a < atoms.cols(); ++a) {
      if (norm[a] > 0.0) most = std::max(most, products(n, a) / norm[a]);
    }
    largest.push_back(most * most);
  }
  Thresholds out;
  out.scan = tail_quantile(std::move(largest), Thresholds::kScanShare);
  out.energy_mean = energy.mean();
  out.energy = tail_quantile({energy.begin(), energy.end()}, Thresholds::kEnergyShare);
  out.local = tail_quantile({local.begin(), local.end()}, Thresholds::kLocalShare);
  return out;
}

}  // namespace

double tail_quantile(std::vector<double> draws, double share) {
  constexpr double kTail = 0.05;
  const EmpiricalCdf cdf(std::move(draws));
  if (share >= kTail) return cdf.quantile(1.0 - share);
  const double start = cdf.quantile(1.0 - kTail);
  double excess = 0.0;
  int count = 0;
  for (const double x : cdf.sorted()) {
    if (x <= start) continue;
    excess += x - start;
    ++count;
  }
  return count == 0 ? start : start + excess / count * std::log(kTail / share);
}

Comparison::Comparison(std::vector<ComparedRecord> records, int threads)
    : records_(std::move(records)), threads_(threads) {
  FATMC_CHECK(!records_.empty(), "a record");
  Eigen::Index size = 0;
  for (const ComparedRecord& r : records_) {
    FATMC_CHECK(r.basis->dictionary.atoms.size() == dictionary().atoms.size(),
                "one dictionary for all records");
    first_.push_back(size);
    size += r.basis->layout.size;
  }
  discrepancy_.resize(size);
  atoms_.resize(size, dictionary().differences.cols());
  resonance_atoms_.resize(size, records_.front().basis->resonance_atoms.cols());
  moment_atoms_.resize(size, records_.front().basis->moment_atoms.cols());
  white_baseline_.resize(size, ComparisonBasis::kPaired);
  std::vector<bool> usable(dictionary().atoms.size(), true);
  for (std::size_t i = 0; i < records_.size(); ++i) {
    const ComparisonBasis& basis = *records_[i].basis;
    discrepancy_.segment(first_[i], basis.layout.size) =
        basis.law.whiten(basis.layout, records_[i].features - basis.law.mean);
    atoms_.middleRows(first_[i], basis.layout.size) = basis.atoms;
    resonance_atoms_.middleRows(first_[i], basis.layout.size) = basis.resonance_atoms;
    moment_atoms_.middleRows(first_[i], basis.layout.size) = basis.moment_atoms;
    for (int n = 0; n < ComparisonBasis::kPaired; ++n) {
      white_baseline_.col(n).segment(first_[i], basis.layout.size) =
          basis.white_baseline.col((n + static_cast<int>(i) * kShift) % ComparisonBasis::kPaired);
    }
    for (std::size_t a = 0; a < usable.size(); ++a) {
      usable[a] = usable[a] && !basis.atoms.col(static_cast<Eigen::Index>(a)).isZero(0.0);
    }
  }
  for (Eigen::Index m = 0; m < moment_atoms_.cols(); ++m) {
    const bool everywhere = std::none_of(records_.begin(), records_.end(), [&](const ComparedRecord& r) {
      return r.basis->moment_atoms.col(m).isZero(0.0);
    });
    if (!everywhere) moment_atoms_.col(m).setZero();
  }
  curves_ = effect_curves(dictionary(), usable);
  thresholds_ = combine(records_, atoms_, first_);
}

Matrix Comparison::atom_products() const {
  Matrix out = records_.front().basis->atom_products;
  for (std::size_t i = 1; i < records_.size(); ++i) out += records_[i].basis->atom_products;
  return out;
}

Eigen::Index Comparison::first_group(std::size_t record) const {
  Eigen::Index out = 0;
  for (std::size_t i = 0; i < record; ++i) out += static_cast<Eigen::Index>(records_[i].basis->groups.size());
  return out;
}

Matrix Comparison::changes(std::span<const std::vector<Effect>> sets, int flights) const {
  FATMC_CHECK(flights <= ComparisonBasis::kPaired, "flights with a baseline");
  Matrix out(size(), static_cast<Eigen::Index>(sets.size()));
  std::vector<bool> failed(sets.size(), false);
  for (std::size_t i = 0; i < records_.size(); ++i) {
    const ComparisonBasis& basis = *records_[i].basis;
    const std::vector<EffectFlights> flown = records_[i].model->fly(sets, 0, flights, threads_);
    Matrix difference = Matrix::Zero(basis.layout.size, out.cols());
    for (std::size_t s = 0; s < sets.size(); ++s) {
      const std::vector<int>& completed = flown[s].completed;
      failed[s] = failed[s] || 2 * completed.size() < static_cast<std::size_t>(flights);
      if (completed.empty()) continue;
      difference.col(static_cast<Eigen::Index>(s)) =
          (flown[s].features(Eigen::all, completed) - basis.baseline(Eigen::all, completed)).rowwise().mean();
    }
    out.middleRows(first_[i], basis.layout.size) = basis.law.whiten(basis.layout, difference);
  }
  for (std::size_t s = 0; s < sets.size(); ++s) {
    if (failed[s])
      out.col(static_cast<Eigen::Index>(s)).setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  return out;
}

double Comparison::local_score(const Eigen::Ref<const Vector>& z,
                               const Eigen::Ref<const Vector>& excess) const {
  double most = -1e300;
  Eigen::Index first_group = 0;
  for (std::size_t i = 0; i < records_.size(); ++i) {
    const ComparisonBasis& basis = *records_[i].basis;
    Vector above = group_sums(basis.groups, z.segment(first_[i], basis.layout.size)) - basis.null.group_mean;
    if (excess.size() > 0) above -= excess.segment(first_group, above.size());
    most = std::max(most, (above.array() / basis.null.group_deviation.array()).maxCoeff());
    first_group += above.size();
  }
  return most;
}

std::vector<int> Comparison::held_out_rows() const {
  std::vector<int> out;
  for (std::size_t i = 0; i < records_.size(); ++i) {
    for (const FeatureBlock& block : records_[i].basis->layout.blocks) {
      if (!held_out(block)) continue;
      for (int r = 0; r < block.size(); ++r) out.push_back(static_cast<int>(first_[i]) + block.first + r);
    }
  }
  return out;
}

std::vector<int> Comparison::training_rows() const {
  std::vector<int> out;
  for (std::size_t i = 0; i < records_.size(); ++i) {
    for (const FeatureBlock& block : records_[i].basis->layout.blocks) {
      if (held_out(block)) continue;
      for (int r = 0; r < block.size(); ++r) out.push_back(static_cast<int>(first_[i]) + block.first + r);
    }
  }
  return out;
}

}  // namespace fatmc
