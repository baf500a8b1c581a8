#include "core/subspace/leading_subspace.h"

#include <algorithm>
#include <limits>
#include <string>

#include "core/base/text.h"
#include "core/random/random_stream.h"
#include "core/subspace/dense_kernels.h"

namespace fatmc {
namespace {

constexpr int kMostPasses = 5;
constexpr double kOrthogonal = 1e-13;
constexpr double kAccepted = 1e-11;  // a residual that stalls above it is a failure

/// Random numbers of no trial: what fills a start block.
Eigen::MatrixXd filling(Eigen::Index rows, Eigen::Index columns) {
  RandomStream stream({0, 0, 0, 0}, "leading-subspace");
  Eigen::MatrixXd out(rows, columns);
  for (Eigen::Index j = 0; j < columns; ++j) {
    for (Eigen::Index i = 0; i < rows; ++i) out(i, j) = stream.normal();
  }
  return out;
}

Eigen::MatrixXd start_block(Eigen::Index size, Eigen::Index width, const Eigen::MatrixXd& start) {
  Eigen::MatrixXd block = Eigen::MatrixXd::Zero(size, width);
  const Eigen::Index given = std::min(start.cols(), width);
  block.topLeftCorner(start.rows(), given) = start.leftCols(given);
  block.rightCols(width - given) = filling(size, width - given);
  orthonormalise(block);
  return block;
}

Result<LeadingSubspace> by_full_decomposition(const Eigen::Ref<const Eigen::MatrixXd>& triangle,
                                              Eigen::Index width) {
  Eigen::MatrixXd full = triangle.triangularView<Eigen::Upper>();
  ThinSvd svd;
  if (!right_singular(full, svd)) return fail("a singular value decomposition did not converge");
  return LeadingSubspace{svd.v.leftCols(width), svd.s.head(width), 0.0, 0};
}

/// Orthonormal bases on the right and on the left, and T times the right one; a block at a time.
struct KrylovSpace {
  Eigen::MatrixXd right, left, image;
  Eigen::Index used = 0;
};

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

void add_block(const Eigen::Ref<const Eigen::MatrixXd>& triangle, const Eigen::MatrixXd& block,
               KrylovSpace& space) {
  Eigen::MatrixXd image = block;
  multiply_triangle(triangle, false, image);
  space.right.middleCols(space.used, block.cols()) = block;
  space.image.middleCols(space.used, block.cols()) = image;
  orthonormalise_outside(space.left.leftCols(space.used), image);
  space.left.middleCols(space.used, block.cols()) = image;
  space.used += block.cols();
}

/// The next block on the right. From the orthonormal block on the left, not from T times that on the right:
/// its columns of small singular values would drown in the rounding of the large ones, squared.
Eigen::MatrixXd next_block(const Eigen::Ref<const Eigen::MatrixXd>& triangle, const KrylovSpace& space,
                           Eigen::Index width) {
  Eigen::MatrixXd next = space.left.middleCols(space.used - width, width);
  multiply_triangle(triangle, true, next);
  orthonormalise_outside(space.right.leftCols(space.used), next);
  return next;
}

}  // namespace

Result<LeadingSubspace> leading_subspace(const Eigen::Ref<const Eigen::MatrixXd>& triangle, int wanted,
                                         const Eigen::MatrixXd& start, const LeadingOptions& options) {
  const Eigen::Index size = triangle.rows(), width = std::min<Eigen::Index>(size, wanted + options.guard);
  const int blocks = options.steps + 1;
  if (size <= options.dense_size || size < blocks * width) return by_full_decomposition(triangle, width);
  Eigen::MatrixXd block = start_block(size, width, start);
  LeadingSubspace out;
  const Eigen::MatrixXd empty(size, blocks * width);
  KrylovSpace space{empty, empty, empty, 0};
  double best = std::numeric_limits<double>::infinity();
  int stalled = 0;
  for (out.restarts = 1; out.restarts <= options.most_restarts; ++out.restarts) {
    space.used = 0;
    add_block(triangle, block, space);
    for (int step = 0; step < options.steps; ++step)
      add_block(triangle, next_block(triangle, space, width), space);
    Eigen::MatrixXd image = space.image;
    ThinSvd svd;
    if (!right_singular(image, svd)) return fail("a singular value decomposition did not converge");
    const Eigen::MatrixXd turn = svd.v.leftCols(width);
    block.setZero();
    add_product(space.right, turn, block);
    out.s = svd.s.head(width);
    // What of T^T w_i, w_i = T u_i / s_i, points out of the block. Inside it the decomposition above has the
    // last word: a share of u_1 in u_i, of the size of rounding, is none that an iteration could remove.
    Eigen::MatrixXd rest = Eigen::MatrixXd::Zero(size, wanted);
    add_product(space.image, turn.leftCols(wanted), rest);
    rest = rest * out.s.head(wanted).cwiseMax(std::numeric_limits<double>::min()).cwiseInverse().asDiagonal();
    multiply_triangle(triangle, true, rest);
    add_product(block, -transposed_product(block, rest), rest);
    out.residual = rest.colwise().norm().maxCoeff() / out.s(0);
    if (!(out.residual <= std::numeric_limits<double>::max())) break;
    stalled = out.residual > 0.5 * best ? stalled + 1 : 0;
    best = std::min(best, out.residual);
    const bool at_round_off = out.residual <= kAccepted && stalled >= 2;
    if (out.residual <= options.tolerance || at_round_off) {
      out.u = std::move(block);
      return out;
    }
  }
  return fail("the leading singular directions did not converge (residual " + significant(out.residual, 2) +
              " of the largest)");
}

}  // namespace fatmc
