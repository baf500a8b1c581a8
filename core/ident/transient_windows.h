// Windows of non-excited bins and the polynomial through them that gives transient and noise of an excited bin.
//
//   T^(k) = sum_i t_i Z(m_i), t the constant-term row of the least-squares polynomial of degree R   (T 2.101-2.110)
//   C_Z_noise = mu_poly e e^H / q,  e = complement^T Z_n,  q = bins - (R + 1)                       (T 2.112-2.115)
//
// The bins of a line are the nearest non-excited ones of P k_1 - (P-1) ... P k_F + (P-1), half on each side (one more
// above where their number is odd), shifted at those ends so that the number stays.
#pragma once

#include <span>
#include <vector>

namespace fatmc {

class TransientWindows {
 public:
  TransientWindows() = default;
  /// `lines`: excited harmonics, ascending; `count` > order + 1 bins a line. Empty (line_count() == 0) where the band
  /// holds fewer than `count` non-excited bins.
  TransientWindows(const std::vector<int>& lines, int period_samples, int periods, int count, int order);

  [[nodiscard]] int line_count() const { return static_cast<int>(mu_.size()); }
  [[nodiscard]] int count() const { return count_; }
  /// Complex degrees of freedom of the residuals, count - (R + 1) (2.113).
  [[nodiscard]] int q() const { return count_ - (order_ + 1); }
  /// Bins 0 ... bin_count()-1 are all that the windows and lines reach.
  [[nodiscard]] int bin_count() const { return bin_count_; }
  /// The bins of line k, ascending.
  [[nodiscard]] std::span<const int> bins(int k) const { return slice(bins_, k, count_); }
  /// t above.
  [[nodiscard]] std::span<const double> weights(int k) const { return slice(weights_, k, count_); }
  /// count x q with orthonormal columns, orthogonal to the polynomials: residual residual^H = e e^H. Column-major.
  [[nodiscard]] std::span<const double> complement(int k) const { return slice(complement_, k, count_ * q()); }
  /// Variance of Z^ = Z - T^ over that of Z: 1 + |t|^2 (2.114, 2.115).
  [[nodiscard]] double mu_poly(int k) const { return mu_[static_cast<std::size_t>(k)]; }

 private:
  template <typename T>
  static std::span<const T> slice(const std::vector<T>& values, int k, int size) {
    const auto length = static_cast<std::size_t>(size);
    return std::span<const T>(values).subspan(static_cast<std::size_t>(k) * length, length);
  }
  void fit(int bin, std::span<const int> bins);

  int count_ = 0, order_ = 0, bin_count_ = 0;
  std::vector<int> bins_;
  std::vector<double> weights_, complement_, mu_;
};

}  // namespace fatmc
