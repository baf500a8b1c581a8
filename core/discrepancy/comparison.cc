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

bool held_out(const FeatureBlock& block) {
  return block.kind == FeatureKind::line && block.line % kHeldBack == 2;
}

/// With an effect some flights may leave the model where the record's did not: the mean change over those that do not, NaN where
/// none is left.
Vector mean_of_survivors(const ModelSimulator& model, const ComparisonBasis& basis,
                         const std::vector<Effect>& effects, int flights, int threads) {
  const std::vector<std::vector<Effect>> sets = {effects};
  Vector sum = Vector::Zero(basis.layout.size);
  int count = 0;
  for (int n = 0; n < flights; ++n) {
    const EffectFlights one = model.fly(sets, n, 1, threads).front();
    if (!one.usable()) continue;
    sum += one.features.col(0) - basis.baseline.col(n);
    ++count;
  }
  if (count == 0) return Vector::Constant(basis.layout.size, std::numeric_limits<double>::quiet_NaN());
  return sum / count;
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
      const Eigen::Index m = (n + static_cast<Eigen::Index>(i) * 37) % flights;
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
  for (std::size_t i = 0; i < records_.size(); ++i) {
    const ComparisonBasis& basis = *records_[i].basis;
    discrepancy_.segment(first_[i], basis.layout.size) =
        basis.law.whiten(basis.layout, records_[i].features - basis.law.mean);
    atoms_.middleRows(first_[i], basis.layout.size) = basis.atoms;
  }
  thresholds_ = combine(records_, atoms_, first_);
}

Matrix Comparison::changes(std::span<const std::vector<Effect>> sets, int flights) const {
  FATMC_CHECK(flights <= ComparisonBasis::kBaseline, "flights with a baseline");
  Matrix out(size(), static_cast<Eigen::Index>(sets.size()));
  std::vector<bool> failed(sets.size(), false);
  for (std::size_t i = 0; i < records_.size(); ++i) {
    const ComparisonBasis& basis = *records_[i].basis;
    const ModelSimulator& model = *records_[i].model;
    const std::vector<EffectFlights> flown = model.fly(sets, 0, flights, threads_);
    Matrix difference(basis.layout.size, out.cols());
    for (std::size_t s = 0; s < sets.size(); ++s) {
      const auto at = static_cast<Eigen::Index>(s);
      if (flown[s].usable()) {
        difference.col(at) = (flown[s].features - basis.baseline.leftCols(flights)).rowwise().mean();
      } else {
        difference.col(at) = mean_of_survivors(model, basis, sets[s], flights, threads_);
        failed[s] = failed[s] || !difference.col(at).allFinite();
      }
    }
    out.middleRows(first_[i], basis.layout.size) = basis.law.whiten(basis.layout, difference);
  }
  for (std::size_t s = 0; s < sets.size(); ++s) {
    if (failed[s])
      out.col(static_cast<Eigen::Index>(s)).setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  return out;
}

double Comparison::local_score(const Eigen::Ref<const Vector>& z) const {
  ResidualLaw law;
  for (const ComparedRecord& r : records_) {
    law.group_mean.push_back(r.basis->null.group_mean);
    law.group_deviation.push_back(r.basis->null.group_deviation);
  }
  return local_score(z, law);
}

double Comparison::local_score(const Eigen::Ref<const Vector>& z, const ResidualLaw& law) const {
  double most = -1e300;
  for (std::size_t i = 0; i < records_.size(); ++i) {
    const ComparisonBasis& basis = *records_[i].basis;
    const Vector sums = group_sums(basis.groups, z.segment(first_[i], basis.layout.size));
    most = std::max(most, ((sums - law.group_mean[i]).array() / law.group_deviation[i].array()).maxCoeff());
  }
  return most;
}

std::optional<ResidualLaw> Comparison::residual_law(const std::vector<Effect>& effects, int flights) const {
  ResidualLaw out;
  const std::vector<std::vector<Effect>> sets = {effects};
  for (const ComparedRecord& r : records_) {
    const ComparisonBasis& basis = *r.basis;
    // Flights beyond the baseline's: their noise has not been subtracted from anything.
    const EffectFlights flown = r.model->fly(sets, ComparisonBasis::kBaseline, flights, threads_).front();
    if (!flown.usable()) return std::nullopt;
    const Vector mean = flown.features.rowwise().mean();
    const Matrix z = basis.law.whiten(basis.layout, flown.features.colwise() - mean);
    const double unbiased = flights / (flights - 1.0);
    Matrix sums(static_cast<Eigen::Index>(basis.groups.size()), flights);
    for (int n = 0; n < flights; ++n) sums.col(n) = unbiased * group_sums(basis.groups, z.col(n));
    out.energy_mean += unbiased * z.squaredNorm() / flights;
    out.group_mean.push_back(sums.rowwise().mean());
    out.group_deviation.push_back(floored_deviation(sums.transpose(), out.group_mean.back()));
  }
  return out;
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
