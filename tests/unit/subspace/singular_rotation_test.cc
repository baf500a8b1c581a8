#include "core/subspace/singular_rotation.h"

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <Eigen/SVD>

#include "core/random/random_stream.h"

namespace fatmc {
namespace {

Eigen::MatrixXd normal(Eigen::Index rows, Eigen::Index columns, std::uint32_t seed) {
  RandomStream stream({seed, 0, 0, 0}, "rotation");
  return Eigen::MatrixXd::NullaryExpr(rows, columns, [&] { return stream.normal(); });
}

TEST(SingularRotation, IsThatOfTheFullDecomposition) {
  for (const Eigen::Index size : {1, 7, 48, 49, 130}) {  // narrower and wider than the band
    // A factor of tall data: well conditioned, so that its singular vectors are determined.
    const Eigen::HouseholderQR<Eigen::MatrixXd> qr(normal(2 * size, size, 1));
    const Eigen::MatrixXd upper = qr.matrixQR().topRows(size).triangularView<Eigen::Upper>();
    Eigen::MatrixXd triangle = upper, rhs = normal(size, 3, 2);
    const Eigen::BDCSVD<Eigen::MatrixXd> svd(upper, Eigen::ComputeFullU);
    const Eigen::MatrixXd expected = svd.matrixU().transpose() * rhs;
    Eigen::VectorXd s;
    ASSERT_TRUE(rotate_to_singular_directions(triangle, rhs, s));
    EXPECT_LT((s - svd.singularValues()).norm(), 1e-13 * s(0)) << size;
    // The sign of a singular vector is free: products of its columns are not.
    EXPECT_LT(
        (rhs.array().colwise() * rhs.col(0).array() - expected.array().colwise() * expected.col(0).array())
            .matrix()
            .norm(),
        1e-10 * rhs.squaredNorm())
        << size;
  }
}

}  // namespace
}  // namespace fatmc
