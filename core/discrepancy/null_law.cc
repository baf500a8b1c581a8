#include "core/discrepancy/null_law.h"

#include <Eigen/Cholesky>

#include "core/base/check.h"

namespace fatmc {
namespace {

using Matrix = Eigen::MatrixXd;

/// Covariance of a line's [Re; Im] from centred samples [Re, Im], as that of a proper complex vector.
Matrix proper_covariance(const Matrix& samples, double divisor) {
  const Eigen::Index c = samples.cols() / 2;
  const Matrix re = samples.leftCols(c), im = samples.rightCols(c);
  // C = E z z^H: Re C = E(re re^T + im im^T), Im C = E(im re^T - re im^T)
  const Matrix real = (re.transpose() * re + im.transpose() * im) / divisor;
  const Matrix cross = im.transpose() * re / divisor;
  const Matrix imaginary = cross - cross.transpose();
  Matrix out(2 * c, 2 * c);
  out << 0.5 * real, -0.5 * imaginary, 0.5 * imaginary, 0.5 * real;
  return out;
}

/// Adds the floors to the covariance of a block.
void add_floors(const FeatureLayout& layout, const FeatureBlock& block, const Eigen::VectorXd& mean,
                Matrix& cov) {
  const auto n = static_cast<Eigen::Index>(block.channels.size());
  for (Eigen::Index i = 0; i < n; ++i) {
    const int channel = block.channels[static_cast<std::size_t>(i)];
    double floor = 0.0;
    if (block.kind == FeatureKind::line) {
      const double re = mean[block.first + i], im = mean[block.first + n + i];
      const bool attitude = layout.attitude && channel >= 3;
      if (attitude) floor = 0.5 * NullLaw::kAttitudeTrust * NullLaw::kAttitudeTrust * (re * re + im * im);
      cov(n + i, n + i) += floor;
    } else if (block.kind == FeatureKind::controller) {
      const double trust = channel >= 3 && channel < 6 ? NullLaw::kOffsetTrust : NullLaw::kGainTrust;
      floor = trust * trust;
    } else if (block.kind == FeatureKind::lattice) {
      floor = NullLaw::kLatticeTrust * NullLaw::kLatticeTrust;
    }
    cov(i, i) += floor;
  }
  // A channel that never moves (exact sensors in calm air) keeps a factor: 1e-12 of the block's scale.
  const double least = 1e-12 * cov.trace() / static_cast<double>(cov.rows()) + 1e-300;
  cov.diagonal().array() += least;
}

}  // namespace

NullLaw NullLaw::fit(const FeatureLayout& layout, const Eigen::Ref<const Matrix>& samples) {
  FATMC_CHECK(samples.cols() == layout.size, "features of this layout");
  const auto count = static_cast<double>(samples.rows());
  NullLaw out;
  out.mean = samples.colwise().mean().transpose();
  const Matrix centred = samples.rowwise() - out.mean.transpose();
  Matrix white(samples.rows(), samples.cols());
  for (const FeatureBlock& block : layout.blocks) {
    const Matrix part = centred.middleCols(block.first, block.size());
    Matrix cov = block.kind == FeatureKind::line ? proper_covariance(part, count - 1.0)
                                                 : Matrix(part.transpose() * part / (count - 1.0));
    add_floors(layout, block, out.mean, cov);
    const Eigen::LLT<Matrix> factor(cov);
    FATMC_CHECK(factor.info() == Eigen::Success, "a covariance with floors is positive definite");
    const Matrix identity = Matrix::Identity(cov.rows(), cov.cols());
    out.inverse_factor.push_back(factor.matrixL().solve(identity));
    white.middleCols(block.first, block.size()) = part * out.inverse_factor.back().transpose();
  }
  out.covariance = LowRankCovariance::fit(white, kMostDirections);
  return out;
}

Matrix NullLaw::whiten_blocks(const FeatureLayout& layout, const Eigen::Ref<const Matrix>& d) const {
  Matrix out(d.rows(), d.cols());
  for (std::size_t b = 0; b < layout.blocks.size(); ++b) {
    const FeatureBlock& block = layout.blocks[b];
    out.middleRows(block.first, block.size()).noalias() =
        inverse_factor[b] * d.middleRows(block.first, block.size());
  }
  return out;
}

Matrix NullLaw::whiten(const FeatureLayout& layout, const Eigen::Ref<const Matrix>& d) const {
  return covariance.whiten(whiten_blocks(layout, d));
}

void NullLaw::add_uncertainty(const FeatureLayout& layout, const Eigen::Ref<const Matrix>& d) {
  covariance = covariance.with(whiten_blocks(layout, d));
}

}  // namespace fatmc
