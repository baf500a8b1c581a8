#include "core/subspace/singular_space.h"

#include <utility>

#include "core/base/check.h"
#include "core/subspace/dense_kernels.h"

namespace fatmc {
namespace {

constexpr int kMostPasses = 5;
constexpr double kOrthogonal = 1e-13;

/// The part of a block outside an orthonormal basis, orthonormal. Columns of which nothing but rounding is
/// left come out as some other directions, which may need more than the usual second pass.
void orthonormalise_outside(const Eigen::Ref<const Eigen::MatrixXd>& basis, Eigen::MatrixXd& block) {
  for (int pass = 0; pass < kMostPasses; ++pass) {
    const Eigen::MatrixXd along = transposed_product(basis, block);
    if (pass > 0 && along.norm() <= kOrthogonal) return;
    add_product(basis, -along, block);
    orthonormalise(block);
  }
}

Eigen::MatrixXd product(const Eigen::Ref<const Eigen::MatrixXd>& a,
                        const Eigen::Ref<const Eigen::MatrixXd>& b) {
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(a.rows(), b.cols());
  add_product(a, b, out);
  return out;
}

}  // namespace

SingularSpace::SingularSpace(const Eigen::Ref<const Eigen::MatrixXd>& triangle, Eigen::Index most)
    : triangle_(triangle),
      right_(triangle.rows(), most),
      left_(triangle.rows(), most),
      middle_(Eigen::MatrixXd::Zero(most, most)) {}

void SingularSpace::take(const Eigen::MatrixXd& u, const Eigen::MatrixXd& w, const Eigen::VectorXd& s) {
  FATMC_CHECK(s.size() <= right_.cols() && u.rows() <= right_.rows(), "SingularSpace: triplets");
  used_ = s.size();
  const Eigen::Index below = right_.rows() - u.rows();
  right_.topLeftCorner(u.rows(), used_) = u;
  right_.bottomLeftCorner(below, used_).setZero();
  left_.topLeftCorner(w.rows(), used_) = w;
  left_.bottomLeftCorner(below, used_).setZero();
  middle_.setZero();
  middle_.topLeftCorner(used_, used_).diagonal() = s;
}

void SingularSpace::add_units(Eigen::Index first) {
  const Eigen::Index count = right_.rows() - first;
  Eigen::MatrixXd block = Eigen::MatrixXd::Zero(right_.rows(), count), image = block;
  block.bottomRows(count).setIdentity();
  for (Eigen::Index j = 0; j < count; ++j)
    image.col(j).head(first + j + 1) = triangle_.col(first + j).head(first + j + 1);
  append(block, image);
}

void SingularSpace::add(Eigen::MatrixXd block) {
  orthonormalise_outside(right_.leftCols(used_), block);
  Eigen::MatrixXd image = block;
  multiply_triangle(triangle_, false, image);
  append(block, image);
}

void SingularSpace::append(const Eigen::MatrixXd& block, const Eigen::MatrixXd& image) {
  const Eigen::Index more = block.cols(), all = used_ + more;
  FATMC_CHECK(all <= right_.cols(), "SingularSpace: no room");
  Eigen::MatrixXd outside = image;
  orthonormalise_outside(left_.leftCols(used_), outside);
  right_.middleCols(used_, more) = block;
  left_.middleCols(used_, more) = outside;
  middle_.block(0, used_, all, more) = transposed_product(left_.leftCols(all), image);
  used_ = all;
}

bool SingularSpace::decompose() {
  Eigen::MatrixXd m = middle_.topLeftCorner(used_, used_);
  return singular_decomposition(m, u_, values_, v_);
}

Eigen::MatrixXd SingularSpace::rights(Eigen::Index count) const {
  return product(right_.leftCols(used_), v_.leftCols(count));
}

Eigen::MatrixXd SingularSpace::lefts(Eigen::Index count) const {
  return product(left_.leftCols(used_), u_.leftCols(count));
}

Eigen::MatrixXd SingularSpace::residuals(const Eigen::MatrixXd& lefts) const {
  Eigen::MatrixXd out = lefts;
  multiply_triangle(triangle_, true, out);
  const auto basis = right_.leftCols(used_);
  add_product(basis, -transposed_product(basis, out), out);
  return out;
}

}  // namespace fatmc
