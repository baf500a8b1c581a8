// SLICOT's AB13MD (GPL, tests only): upper bound of the structured singular value of a complex matrix by D-scaling of
// the whole matrix, an implementation that shares nothing with ours.
#pragma once

#include <Eigen/Core>
#include <complex>
#include <vector>

extern "C" void ab13md_(const char* fact, const int* n, std::complex<double>* z, const int* ldz, const int* m,
                        const int* nblock, const int* itype, double* x, double* bound, double* d, double* g,
                        int* iwork, double* dwork, const int* ldwork, std::complex<double>* zwork, const int* lzwork,
                        int* info);

namespace fatmc::test {

/// Workspace of AB13MD for an n × n matrix with n complex uncertainties of size one.
class SlicotSsv {
 public:
  explicit SlicotSsv(int n)
      : n_(n),
        ones_(size(n), 1),
        complex_(size(n), 2),
        x_(size(2 * n)),
        d_(size(n)),
        g_(size(n)),
        iwork_(size(4 * n + 8)),
        dwork_(size(2 * n * n * n + 9 * n * n + 44 * n + 64)),
        zwork_(size(6 * n * n * n + 12 * n * n + 12 * n + 64)) {}

  struct Result {
    double bound = 0.0;
    int info = 0;  ///< 0: success
  };
  Result upper_bound(const Eigen::MatrixXcd& m) {
    copy_ = m;
    const int ldwork = static_cast<int>(dwork_.size()), lzwork = static_cast<int>(zwork_.size());
    Result out;
    ab13md_("N", &n_, copy_.data(), &n_, &n_, ones_.data(), complex_.data(), x_.data(), &out.bound, d_.data(),
            g_.data(), iwork_.data(), dwork_.data(), &ldwork, zwork_.data(), &lzwork, &out.info);
    return out;
  }

 private:
  static std::size_t size(int n) { return static_cast<std::size_t>(n); }
  int n_;
  Eigen::MatrixXcd copy_;
  std::vector<int> ones_, complex_;
  std::vector<double> x_, d_, g_;
  std::vector<int> iwork_;
  std::vector<double> dwork_;
  std::vector<std::complex<double>> zwork_;
};

}  // namespace fatmc::test
