#include "core/subspace/leading_subspace.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "core/base/check.h"
#include "core/base/text.h"
#include "core/random/random_stream.h"
#include "core/subspace/dense_kernels.h"
#include "core/subspace/singular_space.h"

namespace fatmc {
namespace {

constexpr double kAccepted = 1e-11;  // a residual that stalls above it is a failure
constexpr double kSettled = 0.1;     // of the tolerance: such a triplet adds nothing to the space
constexpr Eigen::Index kExtra = 8;   // random directions beyond those wanted
constexpr Eigen::Index kMostUnits =
    160;  // rows that T may have grown by, for all their unit vectors to enter

/// Random numbers of no trial: what an iteration starts from.
Eigen::MatrixXd filling(Eigen::Index rows, Eigen::Index columns) {
  RandomStream stream({0, 0, 0, 0}, "leading-subspace");
  Eigen::MatrixXd out(rows, columns);
  for (Eigen::Index j = 0; j < columns; ++j) {
    for (Eigen::Index i = 0; i < rows; ++i) out(i, j) = stream.normal();
  }
  return out;
}

void begin(const LeadingTriplets& start, Eigen::Index size, Eigen::Index wanted, SingularSpace& space) {
  const Eigen::Index known = start.u.rows();
  if (start.s.size() > 0) space.take(start.u, start.w, start.s);
  if (start.s.size() >= wanted && size - known <= kMostUnits) {
    if (known < size) space.add_units(known);
  } else {
    space.add(filling(size, wanted + kExtra));
  }
}

Result<LeadingTriplets> by_full_decomposition(const Eigen::Ref<const Eigen::MatrixXd>& triangle,
                                              Eigen::Index kept) {
  Eigen::MatrixXd full = triangle.triangularView<Eigen::Upper>();
  LeadingTriplets out;
  if (!singular_decomposition(full, out.w, out.s, out.u))
    return fail("a singular value decomposition did not converge");
  kept = std::min(kept, out.s.size());
  out.u.conservativeResize(Eigen::NoChange, kept);
  out.w.conservativeResize(Eigen::NoChange, kept);
  out.s.conservativeResize(kept);
  return out;
}

/// How far the wanted triplets of a space are from triplets of T.
class Remainders {
 public:
  explicit Remainders(Eigen::Index wanted) : norms_(Eigen::VectorXd::Constant(wanted, 1.0)) {}

  [[nodiscard]] double worst() const { return norms_.maxCoeff(); }

  /// Of the triplets with (above) or without a norm above `limit` so far: the parts outside the space, of which
  /// those that are still above it come back.
  Eigen::MatrixXd measure(const SingularSpace& space, const Eigen::MatrixXd& lefts, double limit,
                          bool above) {
    std::vector<Eigen::Index> which, open;
    for (Eigen::Index i = 0; i < norms_.size(); ++i) {
      if ((norms_(i) > limit) == above) which.push_back(i);
    }
    const Eigen::MatrixXd outside = space.residuals(lefts(Eigen::all, which));
    for (std::size_t k = 0; k < which.size(); ++k) {
      const auto column = static_cast<Eigen::Index>(k);
      norms_(which[k]) = outside.col(column).norm() / space.values()(0);
      if (!(norms_(which[k]) <= limit)) open.push_back(column);
    }
    return outside(Eigen::all, open);
  }

 private:
  Eigen::VectorXd norms_;  // over s_1
};

LeadingTriplets triplets(const SingularSpace& space, Eigen::Index kept) {
  kept = std::min(kept, space.columns());
  return {space.rights(kept), space.lefts(kept), space.values().head(kept), 0.0, 0};
}

}  // namespace

Result<LeadingTriplets> leading_triplets(const Eigen::Ref<const Eigen::MatrixXd>& triangle, int wanted,
                                         const LeadingTriplets& start, const LeadingOptions& options) {
  const Eigen::Index size = triangle.rows(), most = options.most_columns;
  FATMC_CHECK(start.s.size() <= options.kept && wanted <= options.kept &&
                  options.kept + std::max<Eigen::Index>(kMostUnits, wanted + kExtra) <= most,
              "leading_triplets: options");
  if (size <= options.dense_size || size < wanted + kExtra)
    return by_full_decomposition(triangle, options.kept);
  SingularSpace space(triangle, std::min(most, size));
  begin(start, size, wanted, space);
  Remainders remainders(wanted);
  const double settled = kSettled * options.tolerance;
  double best = std::numeric_limits<double>::infinity();
  int stalled = 0;
  for (int round = 1; round <= options.most_rounds; ++round) {
    if (!space.decompose()) return fail("a singular value decomposition did not converge");
    const Eigen::MatrixXd lefts = space.lefts(wanted);
    const Eigen::MatrixXd directions = remainders.measure(space, lefts, settled, true);
    const auto converged = [&] {
      return remainders.worst() <= options.tolerance || (remainders.worst() <= kAccepted && stalled >= 2);
    };
    stalled = remainders.worst() > 0.5 * best ? stalled + 1 : 0;
    best = std::min(best, remainders.worst());
    if (!std::isfinite(remainders.worst())) break;
    if (converged()) remainders.measure(space, lefts, settled, false);  // those that had settled before
    if (converged()) {
      LeadingTriplets out = triplets(space, options.kept);
      out.residual = remainders.worst();
      out.rounds = round;
      return out;
    }
    if (space.columns() + directions.cols() > std::min(most, size)) {
      const LeadingTriplets cut = triplets(space, options.kept);
      space.take(cut.u, cut.w, cut.s);
    }
    if (directions.cols() > 0) space.add(directions);
  }
  return fail("the leading singular directions did not converge (residual " + significant(best, 2) +
              " of the largest)");
}

}  // namespace fatmc
