#include "core/subspace/singular_rotation.h"

#include <algorithm>
#include <vector>

#include "core/base/check.h"

extern "C" {
void dgeqrf_(const int* m, const int* n, double* a, const int* lda, double* tau, double* work,
             const int* lwork, int* info);
void dormqr_(const char* side, const char* trans, const int* m, const int* n, const int* k, const double* a,
             const int* lda, const double* tau, double* c, const int* ldc, double* work, const int* lwork,
             int* info);
void dgelqf_(const int* m, const int* n, double* a, const int* lda, double* tau, double* work,
             const int* lwork, int* info);
void dormlq_(const char* side, const char* trans, const int* m, const int* n, const int* k, const double* a,
             const int* lda, const double* tau, double* c, const int* ldc, double* work, const int* lwork,
             int* info);
void dgbbrd_(const char* vect, const int* m, const int* n, const int* ncc, const int* kl, const int* ku,
             double* ab, const int* ldab, double* d, double* e, double* q, const int* ldq, double* pt,
             const int* ldpt, double* c, const int* ldc, double* work, int* info);
void dbdsqr_(const char* uplo, const int* n, const int* ncvt, const int* nru, const int* ncc, double* d,
             double* e, double* vt, const int* ldvt, double* u, const int* ldu, double* c, const int* ldc,
             double* work, int* info);
}

namespace fatmc {
namespace {

constexpr int kBand = 48;  // superdiagonals: wide enough for products of matrices, narrow for the rotations

/// What the reflections of one block act on.
struct Reflections {
  std::vector<double> tau = std::vector<double>(kBand), work;
  int length = 0, info = 0;

  explicit Reflections(int n) : work(static_cast<std::size_t>(n) * kBand + 65 * 64) {
    length = static_cast<int>(work.size());
  }
};

/// a <- Q^T a P, upper triangular with kBand superdiagonals; rhs <- Q^T rhs.
void reduce_to_band(Eigen::Ref<Eigen::MatrixXd>& a, Eigen::Ref<Eigen::MatrixXd>& rhs) {
  const int n = static_cast<int>(a.cols()), k = static_cast<int>(rhs.cols()),
            lda = static_cast<int>(std::max<Eigen::Index>(a.outerStride(), n)),
            ldc = static_cast<int>(std::max<Eigen::Index>(rhs.outerStride(), n));
  Reflections r(n);
  for (int first = 0; first < n; first += kBand) {
    const int rows = n - first, width = std::min(kBand, rows), rest = rows - width;
    double* panel = &a(first, first);
    dgeqrf_(&rows, &width, panel, &lda, r.tau.data(), r.work.data(), &r.length, &r.info);
    dormqr_("L", "T", &rows, &k, &width, panel, &lda, r.tau.data(), &rhs(first, 0), &ldc, r.work.data(),
            &r.length, &r.info);
    if (rest == 0) break;
    double* right = &a(first, first + width);
    dormqr_("L", "T", &rows, &rest, &width, panel, &lda, r.tau.data(), right, &lda, r.work.data(), &r.length,
            &r.info);
    const int reflections = std::min(width, rest);
    dgelqf_(&width, &rest, right, &lda, r.tau.data(), r.work.data(), &r.length, &r.info);
    dormlq_("R", "T", &rest, &rest, &reflections, right, &lda, r.tau.data(), &a(first + width, first + width),
            &lda, r.work.data(), &r.length, &r.info);
    FATMC_CHECK(r.info == 0, "reflections to a band");
  }
}

}  // namespace

bool rotate_to_singular_directions(Eigen::Ref<Eigen::MatrixXd> a, Eigen::Ref<Eigen::MatrixXd> rhs,
                                   Eigen::VectorXd& s) {
  FATMC_CHECK(a.rows() == a.cols() && rhs.rows() == a.rows(), "rotate_to_singular_directions: shapes");
  a.triangularView<Eigen::StrictlyLower>().setZero();
  reduce_to_band(a, rhs);
  const int n = static_cast<int>(a.cols()), k = static_cast<int>(rhs.cols()), band = std::min(kBand, n - 1),
            ldab = band + 1, ldc = static_cast<int>(std::max<Eigen::Index>(rhs.outerStride(), n)), zero = 0,
            one = 1;
  Eigen::MatrixXd diagonals = Eigen::MatrixXd::Zero(ldab, n);
  for (int j = 0; j < n; ++j) {
    const int above = std::min(band, j);
    diagonals.col(j).tail(above + 1) = a.col(j).segment(j - above, above + 1);
  }
  Eigen::VectorXd e(std::max(1, n));
  std::vector<double> work(static_cast<std::size_t>(4 * n));
  double none = 0.0;
  int info = 0;
  s.resize(n);
  dgbbrd_("N", &n, &n, &k, &zero, &band, diagonals.data(), &ldab, s.data(), e.data(), &none, &one, &none,
          &one, rhs.data(), &ldc, work.data(), &info);
  FATMC_CHECK(info == 0, "dgbbrd");
  dbdsqr_("U", &n, &zero, &zero, &k, s.data(), e.data(), &none, &one, &none, &one, rhs.data(), &ldc,
          work.data(), &info);
  return info == 0 && s.allFinite();
}

}  // namespace fatmc
