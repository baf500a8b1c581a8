#include "core/subspace/dense_kernels.h"

#include <cblas.h>

#include <algorithm>
#include <vector>

#include "core/base/check.h"

extern "C" {
void dtpqrt_(const int* m, const int* n, const int* l, const int* nb, double* a, const int* lda, double* b,
             const int* ldb, double* t, const int* ldt, double* work, int* info);
void dtpmqrt_(const char* side, const char* trans, const int* m, const int* n, const int* k, const int* l,
              const int* nb, const double* v, const int* ldv, const double* t, const int* ldt, double* a,
              const int* lda, double* b, const int* ldb, double* work, int* info);
void dgeqrf_(const int* m, const int* n, double* a, const int* lda, double* tau, double* work,
             const int* lwork, int* info);
void dormqr_(const char* side, const char* trans, const int* m, const int* n, const int* k, const double* a,
             const int* lda, const double* tau, double* c, const int* ldc, double* work, const int* lwork,
             int* info);
void dorgqr_(const int* m, const int* n, const int* k, double* a, const int* lda, const double* tau,
             double* work, const int* lwork, int* info);
void dgesdd_(const char* jobz, const int* m, const int* n, double* a, const int* lda, double* s, double* u,
             const int* ldu, double* vt, const int* ldvt, double* work, const int* lwork, int* iwork,
             int* info);
}

namespace fatmc {
namespace {

constexpr int kPanel = 32;  // columns of a block reflector

// Debian's OpenBLAS comes with and without threads; sums must not depend on which is installed.
const bool kOneThread = [] {
  openblas_set_num_threads(1);
  return true;
}();

int as_int(Eigen::Index value) { return static_cast<int>(value); }

int leading(Eigen::Index outer_stride, Eigen::Index rows) {
  return as_int(std::max<Eigen::Index>({outer_stride, rows, 1}));
}

/// Asks a LAPACK routine for its workspace, then runs it.
template <typename Call>
void with_workspace(Call call, const char* what) {
  double size = 0.0;
  int info = 0, length = -1;
  call(&size, &length, &info);
  length = std::max(1, static_cast<int>(size));
  std::vector<double> work(static_cast<std::size_t>(length));
  call(work.data(), &length, &info);
  FATMC_CHECK(info == 0, what);
}

}  // namespace

void append_rows(Eigen::Ref<Eigen::MatrixXd> r, Eigen::Ref<Eigen::MatrixXd> rhs,
                 Eigen::Ref<Eigen::MatrixXd> rows, Eigen::Ref<Eigen::MatrixXd> row_rhs) {
  FATMC_CHECK(r.cols() == rows.cols() && r.rows() == rhs.rows() && rows.rows() == row_rhs.rows() &&
                  rhs.cols() == row_rhs.cols(),
              "append_rows: shapes");
  if (r.cols() == 0 || rows.rows() == 0) return;
  const int n = as_int(r.cols()), q = as_int(rows.rows()), k = as_int(rhs.cols()), zero = 0,
            nb = std::min(kPanel, n), ldr = leading(r.outerStride(), n), ldv = leading(rows.outerStride(), q);
  std::vector<double> t(static_cast<std::size_t>(nb) * static_cast<std::size_t>(n));
  std::vector<double> work(static_cast<std::size_t>(nb) * static_cast<std::size_t>(std::max(n, k)));
  int info = 0;
  dtpqrt_(&q, &n, &zero, &nb, r.data(), &ldr, rows.data(), &ldv, t.data(), &nb, work.data(), &info);
  FATMC_CHECK(info == 0, "dtpqrt");
  if (k == 0) return;
  const int ld_rhs = leading(rhs.outerStride(), n), ld_rest = leading(row_rhs.outerStride(), q);
  dtpmqrt_("L", "T", &q, &k, &n, &zero, &nb, rows.data(), &ldv, t.data(), &nb, rhs.data(), &ld_rhs,
           row_rhs.data(), &ld_rest, work.data(), &info);
  FATMC_CHECK(info == 0, "dtpmqrt");
}

void append_rows(Eigen::Ref<Eigen::MatrixXd> r, Eigen::Ref<Eigen::MatrixXd> rows) {
  Eigen::MatrixXd none(r.rows(), 0), rest(rows.rows(), 0);
  append_rows(r, none, rows, rest);
}

void triangularise(Eigen::Ref<Eigen::MatrixXd> a, Eigen::Ref<Eigen::MatrixXd> rhs) {
  FATMC_CHECK(a.rows() >= a.cols() && a.rows() == rhs.rows(), "triangularise: shapes");
  const int m = as_int(a.rows()), n = as_int(a.cols()), k = as_int(rhs.cols()),
            lda = leading(a.outerStride(), m), ldb = leading(rhs.outerStride(), m);
  std::vector<double> tau(static_cast<std::size_t>(n));
  with_workspace([&](double* work, const int* length,
                     int* info) { dgeqrf_(&m, &n, a.data(), &lda, tau.data(), work, length, info); },
                 "dgeqrf");
  with_workspace(
      [&](double* work, const int* length, int* info) {
        dormqr_("L", "T", &m, &k, &n, a.data(), &lda, tau.data(), rhs.data(), &ldb, work, length, info);
      },
      "dormqr");
}

Eigen::MatrixXd zero_triangle(Eigen::Index size) {
  Eigen::MatrixXd out(size, size);
  for (Eigen::Index j = 0; j < size; ++j) out.col(j).head(j + 1).setZero();
  return out;
}

Eigen::MatrixXd upper_triangle(const Eigen::Ref<const Eigen::MatrixXd>& of) {
  Eigen::MatrixXd out(of.cols(), of.cols());
  for (Eigen::Index j = 0; j < of.cols(); ++j) out.col(j).head(j + 1) = of.col(j).head(j + 1);
  return out;
}

void add_product(const Eigen::Ref<const Eigen::MatrixXd>& a, const Eigen::Ref<const Eigen::MatrixXd>& b,
                 Eigen::Ref<Eigen::MatrixXd> out) {
  if (a.rows() == 0 || a.cols() == 0 || b.cols() == 0) return;
  cblas_dgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, as_int(a.rows()), as_int(b.cols()), as_int(a.cols()),
              1.0, a.data(), leading(a.outerStride(), a.rows()), b.data(), leading(b.outerStride(), b.rows()),
              1.0, out.data(), leading(out.outerStride(), out.rows()));
}

Eigen::MatrixXd transposed_product(const Eigen::Ref<const Eigen::MatrixXd>& a,
                                   const Eigen::Ref<const Eigen::MatrixXd>& b) {
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(a.cols(), b.cols());
  if (a.rows() == 0 || a.cols() == 0 || b.cols() == 0) return out;
  cblas_dgemm(CblasColMajor, CblasTrans, CblasNoTrans, as_int(a.cols()), as_int(b.cols()), as_int(a.rows()),
              1.0, a.data(), leading(a.outerStride(), a.rows()), b.data(), leading(b.outerStride(), b.rows()),
              0.0, out.data(), as_int(out.rows()));
  return out;
}

void multiply_triangle(const Eigen::Ref<const Eigen::MatrixXd>& triangle, bool transposed,
                       Eigen::Ref<Eigen::MatrixXd> x) {
  if (x.size() == 0) return;
  cblas_dtrmm(CblasColMajor, CblasLeft, CblasUpper, transposed ? CblasTrans : CblasNoTrans, CblasNonUnit,
              as_int(x.rows()), as_int(x.cols()), 1.0, triangle.data(),
              leading(triangle.outerStride(), triangle.rows()), x.data(), leading(x.outerStride(), x.rows()));
}

void solve_triangle(const Eigen::Ref<const Eigen::MatrixXd>& triangle, Eigen::Ref<Eigen::MatrixXd> x) {
  if (x.size() == 0) return;
  cblas_dtrsm(CblasColMajor, CblasLeft, CblasUpper, CblasNoTrans, CblasNonUnit, as_int(x.rows()),
              as_int(x.cols()), 1.0, triangle.data(), leading(triangle.outerStride(), triangle.rows()),
              x.data(), leading(x.outerStride(), x.rows()));
}

void orthonormalise(Eigen::MatrixXd& a) {
  FATMC_CHECK(a.rows() >= a.cols(), "orthonormalise: shape");
  const int m = as_int(a.rows()), n = as_int(a.cols());
  std::vector<double> tau(static_cast<std::size_t>(n));
  with_workspace([&](double* work, const int* length,
                     int* info) { dgeqrf_(&m, &n, a.data(), &m, tau.data(), work, length, info); },
                 "dgeqrf");
  with_workspace([&](double* work, const int* length,
                     int* info) { dorgqr_(&m, &n, &n, a.data(), &m, tau.data(), work, length, info); },
                 "dorgqr");
}

bool singular_decomposition(Eigen::MatrixXd& a, Eigen::MatrixXd& u, Eigen::VectorXd& s, Eigen::MatrixXd& v) {
  FATMC_CHECK(a.rows() == a.cols(), "singular_decomposition: shape");
  const int n = as_int(a.cols());
  s.resize(n);
  u.resize(n, n);
  Eigen::MatrixXd vt(n, n);
  std::vector<int> integers(static_cast<std::size_t>(8 * n));
  std::vector<double> work(1);
  int info = 0;
  for (int length : {-1, 0}) {  // asks for its workspace, then runs
    if (length == 0) {
      length = std::max(1, static_cast<int>(work.front()));
      work.resize(static_cast<std::size_t>(length));
    }
    dgesdd_("S", &n, &n, a.data(), &n, s.data(), u.data(), &n, vt.data(), &n, work.data(), &length,
            integers.data(), &info);
  }
  v = vt.transpose();
  return info == 0 && s.allFinite();
}

}  // namespace fatmc
