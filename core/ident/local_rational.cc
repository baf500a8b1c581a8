#include "core/ident/local_rational.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "core/ident/aperiodic_windows.h"
#include "core/ident/line_loop.h"
#include "core/ident/line_regression.h"
#include "core/ident/mean_spectra.h"

namespace fatmc {
namespace {

using Matrix = Eigen::MatrixXcd;

/// Of |L^+ L - 1| in the rows of b_0, between rounding and the 1/2 of two references alike.
constexpr double kUndetermined = 1e-3;

/// One line's window: everything the fits need.
struct Window {
  Eigen::VectorXd x;  ///< offsets, largest magnitude 1
  Matrix known;       ///< width x n_in
  Matrix channels;    ///< width x channels
  bool transient = false;
};

/// Columns y x, ..., y x^R | transient | known x^R, ..., known; the first block only with `y`.
Matrix regressor(const Window& w, int order, const Eigen::VectorXcd* y) {
  const Eigen::Index n = w.known.cols(), width = w.x.size();
  const Eigen::Index poles = y == nullptr ? 0 : order, transient = w.transient ? order + 1 : 0;
  Matrix out(width, poles + transient + (order + 1) * n);
  for (Eigen::Index i = 0; i < width; ++i) {
    double power = 1.0;
    for (int s = 0; s <= order; ++s, power *= w.x(i)) {
      if (s > 0 && y != nullptr) out(i, s - 1) = -power * (*y)(i);
      if (w.transient) out(i, poles + s) = power;
      out.row(i).segment(poles + transient + (order - s) * n, n) = power * w.known.row(i);
    }
  }
  return out;
}

/// Least distance of a root of 1 + a_1 x + ... + a_R x^R from the points `x`; infinite without roots. Roots are the
/// inverses of the eigenvalues of a companion matrix, so that a vanishing a_R is a root at infinity, no special case.
double pole_distance(const Eigen::VectorXcd& a, const Eigen::VectorXd& x) {
  const Eigen::Index r = a.size();
  double least = std::numeric_limits<double>::infinity();
  if (r == 0) return least;
  Matrix companion = Matrix::Zero(r, r);
  companion.row(0) = -a.transpose();
  companion.diagonal(-1).setOnes();
  const Eigen::VectorXcd inverses = companion.eigenvalues();
  for (const std::complex<double>& t : inverses) {
    // |1/t - x| = |1 - x t| / |t|
    for (const double point : x) {
      if (std::abs(t) > 0.0) least = std::min(least, std::abs(1.0 - point * t) / std::abs(t));
    }
  }
  return least;
}

struct RationalFit {
  Matrix G_Z;  ///< channels x n_in
  Matrix C_Z;
  std::vector<Matrix> P;  ///< a channel: n_in x width, times A_c of every row: what maps V_c to b_c0
  double condition = 1.0;
  bool trusted = true;
};

/// 1 + a_1 x + ... + a_R x^R at every point.
Eigen::VectorXcd denominator(const Eigen::VectorXcd& a, const Eigen::VectorXd& x) {
  Eigen::VectorXcd value = Eigen::VectorXcd::Zero(x.size());
  for (Eigen::Index s = a.size(); s-- > 0;) value = (value.array() + a(s)) * x.array();
  return value.array() + 1.0;
}

RationalFit fit(const Window& w, const LocalRationalOptions& options) {
  const Eigen::Index n = w.known.cols(), width = w.x.size(), channels = w.channels.cols();
  const double spacing = (w.x.maxCoeff() - w.x.minCoeff()) / static_cast<double>(width - 1);
  RationalFit out;
  out.G_Z.resize(channels, n);
  Matrix residual(channels, width);
  std::vector<Matrix> spread;  // a channel: (I - L L^+) diag(A_c), what maps V_c to the residuals
  for (Eigen::Index c = 0; c < channels; ++c) {
    const Eigen::VectorXcd y = w.channels.col(c);
    Matrix l = regressor(w, options.order, &y);
    Eigen::VectorXd length = l.colwise().norm();
    if (!(length.tail(n).minCoeff() > 0.0)) {
      out.trusted = false;
      return out;
    }
    length = (length.array() > 0.0).select(length, 1.0);
    l = l * length.cwiseInverse().asDiagonal();
    // Without noise, a response of lower order leaves common factors of A and B open: the smallest solution puts their
    // roots far away, and b_0 does not depend on the choice.
    Eigen::CompleteOrthogonalDecomposition<Matrix> decomposition;
    decomposition.setThreshold(1e-14);
    decomposition.compute(l);
    const Matrix inverse = decomposition.pseudoInverse();
    // What the smallest solution does not leave open is a row of L^+ L = 1; two inputs alike make theirs 1/2.
    Matrix open = inverse.bottomRows(n) * l;
    open.rightCols(n) -= Matrix::Identity(n, n);
    if (!(open.norm() < kUndetermined)) {
      out.trusted = false;  // polynomials say whether it is the window or the references
      return out;
    }
    const Eigen::VectorXcd theta = inverse * y;
    residual.row(c) = (y - l * theta).transpose();
    out.G_Z.row(c) = length.tail(n).cwiseInverse().asDiagonal() * theta.tail(n);
    if (!theta.allFinite()) {
      out.trusted = false;
      return out;
    }
    const Eigen::VectorXcd a =
        length.head(options.order).cwiseInverse().asDiagonal() * theta.head(options.order);
    out.trusted = out.trusted && pole_distance(a, w.x) > options.guard * spacing;
    const Eigen::VectorXcd weight = denominator(a, w.x);
    out.P.push_back(length.tail(n).cwiseInverse().asDiagonal() * inverse.bottomRows(n) * weight.asDiagonal());
    spread.push_back((Matrix::Identity(width, width) - l * inverse) * weight.asDiagonal());
    const Eigen::VectorXd diagonal =
        decomposition.matrixQTZ().diagonal().cwiseAbs().head(decomposition.rank());
    out.condition = std::max(out.condition, diagonal.maxCoeff() / diagonal.minCoeff());
  }
  out.C_Z.resize(channels, channels);
  for (Eigen::Index c = 0; c < channels; ++c) {
    for (Eigen::Index d = 0; d <= c; ++d) {
      // E residual_c residual_d^H = C_Z,cd tr(spread_c spread_d^H)
      const std::complex<double> expected = (spread[static_cast<std::size_t>(c)].array() *
                                             spread[static_cast<std::size_t>(d)].array().conjugate())
                                                .sum();
      const double size = std::abs(expected);
      out.C_Z(c, d) = size > 0.0 ? residual.row(d).dot(residual.row(c)) / expected : 0.0;
      out.C_Z(d, c) = std::conj(out.C_Z(c, d));
    }
  }
  return out;
}

/// sum_cd v_c conj(v_d) C_cd sum_w x_c(w) conj(x_d(w)), x_c = K_j^T P_c diag(A_c): variance of one element.
double element_variance(const RationalFit& f, const Eigen::RowVectorXcd& v,
                        const Eigen::VectorXcd& k_column) {
  const Eigen::Index channels = f.G_Z.rows();
  Matrix x(channels, f.P.front().cols());
  for (Eigen::Index c = 0; c < channels; ++c)
    x.row(c) = v(c) * (k_column.transpose() * f.P[static_cast<std::size_t>(c)]);
  return (f.C_Z.array() * (x * x.adjoint()).array()).sum().real();
}

void store_rational(FrmEstimate& e, int k, const RationalFit& f) {
  // The estimate itself follows the polynomial's rule; A is a stand-in that store_line moves to B and is taken out again.
  store_line(e, k, {f.G_Z, f.C_Z, Matrix::Identity(e.n_in, e.n_in), f.condition});
  if (e.status[static_cast<std::size_t>(k)] != LineStatus::ok) return;
  Matrix v = Matrix::Identity(e.n_out, f.G_Z.rows());
  Matrix inverse = Matrix::Identity(e.n_in, e.n_in);
  if (e.indirect) {
    v.rightCols(e.n_in) = -e.G[k];
    inverse = f.G_Z.bottomRows(e.n_in).inverse();
  }
  for (int i = 0; i < e.n_out; ++i) {
    for (int j = 0; j < e.n_in; ++j)
      e.element_variance[k](i, j) = element_variance(f, v.row(i), inverse.col(j));
  }
}

/// Whether the line had to fall back to polynomials.
bool estimate_line(FrmEstimate& e, int k, const Window& w, const LocalRationalOptions& options) {
  const RationalFit rational = fit(w, options);
  if (rational.trusted) {
    store_rational(e, k, rational);
  } else {
    store_line(e, k, regress_line(regressor(w, options.order, nullptr), w.channels, e.n_in));
    for (int i = 0; i < e.n_out; ++i) {
      for (int j = 0; j < e.n_in; ++j)
        e.element_variance[k](i, j) = e.B[k](j, j).real() * e.C_V[k](i, i).real();
    }
  }
  e.B[k].setZero();
  e.C_V[k].setZero();
  return !rational.trusted;
}

/// estimate_line for all lines, `window(k)` being theirs.
template <typename WindowOf>
void estimate_lines(ResponseEstimate& out, const LocalRationalOptions& options, const WindowOf& window) {
  FrmEstimate& e = out.frm;
  std::vector<char> fell_back(e.lines.size(), 0);
  for_each_line(e.line_count(), options.threads, [&](int k) {
    fell_back[static_cast<std::size_t>(k)] = estimate_line(e, k, window(k), options) ? 1 : 0;
  });
  for (std::size_t k = 0; k < fell_back.size(); ++k) {
    if (fell_back[k] != 0) out.fallback.push_back(e.lines[k]);
  }
}

Status check(const Measurement& m, const LocalRationalOptions& o, bool periodic) {
  const int parameters = (o.order + 1) * m.n_in() + o.order + (periodic ? 0 : o.order + 1);
  if (o.order < 1 || o.order > 8)
    return fail(Error{"", 0, "order", std::to_string(o.order) + " is not in 1 ... 8"});
  if (2 * o.n_e + 1 <= parameters) {
    return fail(Error{"", 0, "n-e",
                      "a rational fit of order " + std::to_string(o.order) + " has " +
                          std::to_string(parameters) +
                          " unknowns, take n_E >= " + std::to_string((parameters + 1) / 2)});
  }
  return {};
}

Result<ResponseEstimate> of_periods(const Measurement& m, const LocalRationalOptions& options) {
  // The fast LPM's grid serves both as windows and as the check of lines and periods; its q is that of the polynomial.
  Result<LpmGrid> grid =
      LpmGrid::create(m.experiment, {options.n_e, options.order, options.n_transient}, m.n_in());
  if (!grid) return fail(grid.error());
  const MeanSpectra spectra = remove_transient(m, grid->transient());
  ResponseEstimate out;
  FrmEstimate& e = out.frm;
  e.n_out = m.n_out();
  e.n_in = m.n_in();
  e.indirect = m.indirect();
  e.lines = m.experiment.lines;
  for (int k = 0; k < grid->line_count(); ++k) e.frequency_hz.push_back(grid->frequency_hz(k));
  size_estimate(e);
  e.q = grid->q() - options.order;
  e.q_noise = grid->q_noise();
  e.element_variance.resize(e.n_out, e.n_in, e.line_count());
  estimate_lines(out, options, [&](int k) {
    e.border[static_cast<std::size_t>(k)] = grid->border(k) ? 1 : 0;
    e.C_Z_noise[k] = spectra.noise[k];
    store_input_quality(e, k, spectra.mean.row(k).tail(e.n_in).transpose());
    Window w;
    const auto x = grid->scaled_offsets(k);
    w.x = Eigen::Map<const Eigen::VectorXd>(x.data(), static_cast<Eigen::Index>(x.size()));
    const Matrix z = spectra.mean.middleRows(grid->first(k), grid->window());
    w.channels = e.indirect ? z : Matrix(z.leftCols(e.n_out));
    w.known = e.indirect ? Matrix(spectra.reference.middleRows(grid->first(k), grid->window()))
                         : Matrix(z.rightCols(e.n_in));
    return w;
  });
  return out;
}

Result<ResponseEstimate> of_record(const Measurement& m, const LocalRationalOptions& options) {
  const int width = 2 * options.n_e + 1, n = m.n_in();
  const Result<BinBand> band = bin_band(m, width);
  if (!band) return fail(band.error());
  ResponseEstimate out;
  FrmEstimate& e = out.frm;
  begin_estimate(m, *band, width, e);
  e.q = width - (options.order + 1) * (n + 1) - options.order;
  e.element_variance.resize(e.n_out, n, e.line_count());
  Matrix z(band->last + 1, e.n_out + n);
  z << record_spectrum(m.outputs, band->last + 1), record_spectrum(m.inputs, band->last + 1);
  Matrix known = e.indirect ? record_spectrum(m.references, band->last + 1) : z.rightCols(n);
  drop_rounding(known);
  estimate_lines(out, options, [&](int k) {
    Window w;
    w.transient = true;
    const int bin = e.lines[static_cast<std::size_t>(k)], first = band->window(bin, width);
    const int largest = std::max(bin - first, first + width - 1 - bin);
    w.x = Eigen::VectorXd::LinSpaced(width, first - bin, first + width - 1 - bin) / largest;
    w.known = known.middleRows(first, width);
    w.channels = z.middleRows(first, width).leftCols(e.indirect ? e.n_out + n : e.n_out);
    store_input_quality(e, k, z.row(bin).tail(n).transpose());
    return w;
  });
  return out;
}

}  // namespace

Result<ResponseEstimate> local_rational(const Measurement& m, const LocalRationalOptions& options) {
  const bool periodic = m.experiment.periods >= 2 && !m.experiment.lines.empty();
  if (Status status = check(m, options, periodic); !status) return fail(status.error());
  Result<ResponseEstimate> out = periodic ? of_periods(m, options) : of_record(m, options);
  if (out && !out->fallback.empty()) {
    out->notes.push_back("at " + std::to_string(out->fallback.size()) + " of " +
                         std::to_string(out->frm.line_count()) +
                         " lines a pole lies too near the lines: local polynomials there");
  }
  return out;
}

}  // namespace fatmc
