#include "core/ident/transient_windows.h"

#include <Eigen/QR>
#include <algorithm>
#include <cstdlib>

#include "core/base/check.h"

namespace fatmc {

TransientWindows::TransientWindows(const std::vector<int>& lines, int period_samples, int periods, int count,
                                   int order)
    : count_(count), order_(order) {
  FATMC_CHECK(!lines.empty() && count > order + 1 && periods >= 1, "lines and a degree of freedom");
  const int low = std::max(0, lines.front() * periods - (periods - 1));
  // Above half the rate there is nothing new; the half itself is real, not complex.
  const int high = std::min(lines.back() * periods + (periods - 1), (periods * period_samples - 1) / 2);
  std::vector<int> candidates;
  auto next = lines.begin();
  for (int m = low; m <= high; ++m) {
    if (next != lines.end() && m == *next * periods) {
      ++next;
    } else {
      candidates.push_back(m);
    }
  }
  const int available = static_cast<int>(candidates.size());
  if (available < count) return;
  bin_count_ = high + 1;
  for (const int line : lines) {
    const int bin = line * periods;
    const int above = static_cast<int>(std::lower_bound(candidates.begin(), candidates.end(), bin) - candidates.begin());
    const int start = std::clamp(above - count / 2, 0, available - count);
    fit(bin, std::span(candidates).subspan(static_cast<std::size_t>(start), static_cast<std::size_t>(count)));
  }
}

// K^T = Q [R; 0]; the constant term of the fit is the first row of R^-1 Q_1^T, the residuals' coordinates are Q_2^T Z.
void TransientWindows::fit(int bin, std::span<const int> bins) {
  bins_.insert(bins_.end(), bins.begin(), bins.end());
  const double largest = std::max(std::abs(bins.front() - bin), std::abs(bins.back() - bin));
  Eigen::MatrixXd basis(count_, order_ + 1);
  for (int i = 0; i < count_; ++i) {
    const double x = (bins[static_cast<std::size_t>(i)] - bin) / largest;
    double power = 1.0;
    for (int g = 0; g <= order_; ++g, power *= x) basis(i, g) = power;
  }
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(basis);
  const Eigen::MatrixXd q = qr.householderQ();
  const Eigen::Index p = basis.cols();
  Eigen::VectorXd row = Eigen::VectorXd::Unit(p, 0);
  qr.matrixQR().topRows(p).triangularView<Eigen::Upper>().transpose().solveInPlace(row);
  const Eigen::VectorXd t = q.leftCols(p) * row;
  weights_.insert(weights_.end(), t.begin(), t.end());
  mu_.push_back(1.0 + t.squaredNorm());
  const Eigen::MatrixXd rest = q.rightCols(count_ - p);
  complement_.insert(complement_.end(), rest.data(), rest.data() + rest.size());
}

}  // namespace fatmc
