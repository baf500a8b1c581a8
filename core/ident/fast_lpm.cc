#include "core/ident/fast_lpm.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/check.h"
#include "core/signal/dft.h"

namespace fatmc {
namespace {

std::size_t index(int i) { return static_cast<std::size_t>(i); }
int batch_count(int lines) { return (lines + kLanes - 1) / kLanes; }
/// Line of a lane; the last batch repeats the last line.
int line_of(int batch, int lane, int lines) { return std::min(batch * kLanes + lane, lines - 1); }

/// Where the parts of a factored batch lie: reflectors and R, its diagonal, R33^-1, A.
struct FactorLayout {
  int window, parameters, n_in;
  explicit FactorLayout(const LpmGrid& grid)
      : window(grid.window()), parameters(grid.parameters()), n_in(grid.n_in()) {}
  [[nodiscard]] int diagonal() const { return window * parameters; }
  [[nodiscard]] int inverse() const { return diagonal() + parameters; }
  [[nodiscard]] int a() const { return inverse() + n_in * n_in; }
  [[nodiscard]] int size() const { return a() + n_in * n_in; }
};

void gather(const LpmGrid& grid, int batch, const Eigen::Ref<const LineSpectra>& spectra, int channel,
            ComplexLanes* out) {
  for (int lane = 0; lane < kLanes; ++lane) {
    const std::complex<double>* from =
        spectra.col(channel).data() + grid.first(line_of(batch, lane, grid.line_count()));
    for (int w = 0; w < grid.window(); ++w) {
      out[w].re[lane] = from[w].real();
      out[w].im[lane] = from[w].imag();
    }
  }
}

/// out = X^-1 X^-H of an upper triangular X, n x n.
void gram_of_inverse(const ComplexLanes* inverse, int n, ComplexLanes* out) {
  for (int m = 0; m < n; ++m) {
    for (int j = 0; j < n; ++j) {
      ComplexLanes sum = zero_lanes();
      for (int c = std::max(j, m); c < n; ++c) add_product_conj(sum, inverse[c * n + j], inverse[c * n + m]);
      out[m * n + j] = sum;
    }
  }
}

void unit(ComplexLanes* x, int n) {
  for (int i = 0; i < n * n; ++i) x[i] = zero_lanes();
  for (int i = 0; i < n; ++i) x[i * n + i].re = Lanes::Ones();
}

/// QR of L^T for the lines of one batch, columns d^R kron R, ..., d kron R, R.
void factor_batch(const LpmGrid& grid, int batch, const Eigen::Ref<const LineSpectra>& reference,
                  ComplexLanes* factors) {
  const FactorLayout layout(grid);
  const int w_count = layout.window, n = layout.n_in, order = grid.options().order;
  for (int i = 0; i < n; ++i) gather(grid, batch, reference, i, factors + (order * n + i) * w_count);
  for (int lane_row = 0; lane_row < w_count; ++lane_row) {
    Lanes d;
    for (int lane = 0; lane < kLanes; ++lane) {
      d[lane] = grid.scaled_offsets(line_of(batch, lane, grid.line_count()))[index(lane_row)];
    }
    for (int column = order * n - 1; column >= 0; --column) {
      const ComplexLanes& lower = factors[(column + n) * w_count + lane_row];
      factors[column * w_count + lane_row] = {lower.re * d, lower.im * d};
    }
  }
  householder_factor(factors, w_count, layout.parameters, factors + layout.diagonal());
  unit(factors + layout.inverse(), n);
  back_substitute(factors, w_count, layout.parameters, factors + layout.diagonal(), layout.parameters - n,
                  factors + layout.inverse(), n, n);
  gram_of_inverse(factors + layout.inverse(), n, factors + layout.a());
}

/// Largest over smallest magnitude of `count` diagonal entries, infinite where one is zero.
Lanes diagonal_ratio(const ComplexLanes* diagonal, int count) {
  Lanes low = Lanes::Constant(std::numeric_limits<double>::max()), high = Lanes::Zero();
  for (int i = 0; i < count; ++i) {
    const Lanes square = diagonal[i].re.square() + diagonal[i].im.square();
    low = low.min(square);
    high = high.max(square);
  }
  return (low > 0.0).select((high / low).sqrt(), Lanes::Constant(std::numeric_limits<double>::infinity()));
}

/// Beyond this a diagonal entry is round-off of the others.
constexpr double kSingular = 1e13;

/// sum over all entries of |x|^2
Lanes square_norm(const ComplexLanes* x, int count) {
  Lanes sum = Lanes::Zero();
  for (int i = 0; i < count; ++i) sum += x[i].re.square() + x[i].im.square();
  return sum;
}

}  // namespace

LpmDesign::LpmDesign(const LpmGrid& grid, const Eigen::Ref<const LineSpectra>& reference)
    : batches_(batch_count(grid.line_count())) {
  FATMC_CHECK(reference.rows() == grid.line_count() && reference.cols() == grid.n_in(), "line_count x n_in");
  const FactorLayout layout(grid);
  factors_.resize(index(batches_) * index(layout.size()));
  for (int b = 0; b < batches_; ++b) factor_batch(grid, b, reference, factors_.data() + b * layout.size());
}

FastLpm::FastLpm(LpmGrid grid, int n_out)
    : grid_(std::move(grid)), n_out_(n_out), n_in_(grid_.n_in()), n_z_(n_out + grid_.n_in()) {
  FATMC_CHECK(n_out >= 1, "at least one output");
  const int lines = grid_.line_count();
  spectra_.setZero(grid_.bin_count(), n_z_);
  mean_.setZero(lines, n_z_);
  noise_.resize(index(batch_count(lines) * grid_.q_noise() * n_z_));
  lay_out_transient_weights();
  factors_.resize(index(FactorLayout(grid_).size()));
  z_.resize(index(grid_.window() * n_z_));
  c_z_.resize(index(n_z_ * n_z_));
  g_z_.resize(index(n_in_ * n_z_));
  small_.resize(index(n_in_ * n_in_ + n_in_));
  solved_.resize(index(n_in_ * n_z_));
  v_.resize(index(std::max(grid_.q(), grid_.q_noise()) * n_out_));
  c_v_.resize(index(n_out_ * n_out_));
  b_.resize(index(n_in_ * n_in_));

  FrmEstimate& e = estimate_;
  e.n_out = n_out_;
  e.n_in = n_in_;
  e.q = grid_.q();
  e.q_noise = grid_.q_noise();
  e.lines = grid_.experiment().lines;
  for (int k = 0; k < lines; ++k) {
    e.frequency_hz.push_back(grid_.frequency_hz(k));
    e.border.push_back(grid_.border(k) ? 1 : 0);
  }
  e.G.resize(n_out_, n_in_, lines);
  e.B.resize(n_in_, n_in_, lines);
  e.C_V.resize(n_out_, n_out_, lines);
  e.C_Z_noise.resize(n_z_, n_z_, lines);
  e.C_V_noise.resize(n_out_, n_out_, lines);
  e.U_mean.resize(n_in_, 1, lines);
  e.input_snr.resize(n_in_, 1, lines);
  e.outlier.resize(n_in_, 1, lines);
  e.status.assign(index(lines), LineStatus::ok);
  e.regressor_condition.assign(index(lines), 0.0);
  e.input_condition.assign(index(lines), 1.0);
}

void FastLpm::load(const Eigen::Ref<const Eigen::MatrixXd>& outputs, const Eigen::Ref<const Eigen::MatrixXd>& inputs) {
  FATMC_CHECK(outputs.rows() == grid_.total_samples() && inputs.rows() == grid_.total_samples() &&
                  outputs.cols() == n_out_ && inputs.cols() == n_in_,
              "total_samples x channels");
  const RealDft dft(grid_.total_samples());
  for (int c = 0; c < n_z_; ++c) {
    const double* x = c < n_out_ ? outputs.col(c).data() : inputs.col(c - n_out_).data();
    dft.transform({x, index(grid_.total_samples())}, {spectra_.col(c).data(), index(grid_.bin_count())});
  }
  for (int b = 0; b < batch_count(grid_.line_count()); ++b) load_batch(b);
}

void FastLpm::load_spectra(const Eigen::Ref<const Eigen::MatrixXcd>& outputs,
                           const Eigen::Ref<const Eigen::MatrixXcd>& inputs) {
  FATMC_CHECK(outputs.rows() == grid_.bin_count() && inputs.rows() == grid_.bin_count() &&
                  outputs.cols() == n_out_ && inputs.cols() == n_in_,
              "bin_count x channels");
  spectra_.leftCols(n_out_) = outputs;
  spectra_.rightCols(n_in_) = inputs;
  for (int b = 0; b < batch_count(grid_.line_count()); ++b) load_batch(b);
}

// Transient and noise of one batch: Z^ into mean_, residual coordinates into noise_, C_Z_noise and the input's figures
// into the estimate.
void FastLpm::load_batch(int batch) {
  const int lines = grid_.line_count(), bins = 2 * grid_.options().n_transient, q = grid_.q_noise();
  ComplexLanes* residual = noise_.data() + batch * q * n_z_;
  const Lanes* weights = transient_.data() + batch * (1 + q) * bins;
  for (int c = 0; c < n_z_; ++c) {
    const std::complex<double>* z = spectra_.col(c).data();
    for (int lane = 0; lane < kLanes; ++lane) {
      const auto where = grid_.transient().bins(line_of(batch, lane, lines));
      for (int i = 0; i < bins; ++i) {
        window_[index(i)].re[lane] = z[where[index(i)]].real();
        window_[index(i)].im[lane] = z[where[index(i)]].imag();
      }
    }
    for (int r = 0; r <= q; ++r) {
      ComplexLanes sum = zero_lanes();
      for (int i = 0; i < bins; ++i) {
        sum.re += weights[r * bins + i] * window_[index(i)].re;
        sum.im += weights[r * bins + i] * window_[index(i)].im;
      }
      if (r < q) {
        residual[c * q + r] = sum;
      } else {
        for (int lane = 0; lane < kLanes; ++lane) {
          const int k = line_of(batch, lane, lines);
          mean_(k, c) = z[grid_.bin(k)] - std::complex<double>(sum.re[lane], sum.im[lane]);
        }
      }
    }
  }
  covariance(residual, q, q, n_z_, 1.0 / q, c_z_.data());
  for (int lane = 0; lane < kLanes; ++lane) {
    const int k = line_of(batch, lane, lines);
    std::complex<double>* c = estimate_.C_Z_noise.data(k);
    for (int i = 0; i < n_z_ * n_z_; ++i) c[i] = {c_z_[index(i)].re[lane], c_z_[index(i)].im[lane]};
    for (int j = 0; j < n_in_; ++j) {
      const double deviation = std::sqrt(c[(n_out_ + j) * (n_z_ + 1)].real());
      const std::complex<double> u = mean_(k, n_out_ + j);
      const double magnitude = std::sqrt(std::norm(u));
      estimate_.U_mean.data(k)[j] = u;
      estimate_.input_snr.data(k)[j] =
          deviation > 0.0 ? (magnitude - deviation) / deviation : std::numeric_limits<double>::infinity();
      estimate_.outlier.data(k)[j] = magnitude < 3.0 * deviation ? 1 : 0;
    }
  }
}

// Weights of the transient fits, a lane a line: q_noise rows of residual coordinates, times sqrt(mu_poly) so that their
// covariance is that of the sample mean (2.114), then the row that gives the transient.
void FastLpm::lay_out_transient_weights() {
  const int lines = grid_.line_count(), bins = 2 * grid_.options().n_transient, q = grid_.q_noise();
  transient_.resize(index(batch_count(lines) * (1 + q) * bins));
  window_.resize(index(bins));
  for (int lane = 0; lane < kLanes; ++lane) {
    for (int batch = 0; batch < batch_count(lines); ++batch) {
      const int k = line_of(batch, lane, lines);
      Lanes* weights = transient_.data() + batch * (1 + q) * bins;
      for (int i = 0; i < q * bins; ++i) {
        weights[i][lane] = std::sqrt(grid_.transient().mu_poly(k)) * grid_.transient().complement(k)[index(i)];
      }
      for (int i = 0; i < bins; ++i) weights[q * bins + i][lane] = grid_.transient().weights(k)[index(i)];
    }
  }
}

void FastLpm::begin(bool indirect) {
  estimate_.indirect = indirect;
  const int n = indirect ? n_z_ : n_out_;
  if (estimate_.C_Z.rows() != n) estimate_.C_Z.resize(n, n, grid_.line_count());
}

const FrmEstimate& FastLpm::indirect(const Eigen::Ref<const LineSpectra>& reference) {
  FATMC_CHECK(reference.rows() == grid_.line_count() && reference.cols() == n_in_, "line_count x n_in");
  begin(true);
  for (int b = 0; b < batch_count(grid_.line_count()); ++b) {
    factor_batch(grid_, b, reference, factors_.data());
    finish_batch(b, factors_.data());
  }
  return estimate_;
}

const FrmEstimate& FastLpm::indirect(const LpmDesign& design) {
  const int size = FactorLayout(grid_).size();
  FATMC_CHECK(design.factors_.size() == index(batch_count(grid_.line_count())) * index(size), "a design of this grid");
  begin(true);
  for (int b = 0; b < design.batches_; ++b) finish_batch(b, design.factors_.data() + b * size);
  return estimate_;
}

const FrmEstimate& FastLpm::direct() {
  begin(false);
  for (int b = 0; b < batch_count(grid_.line_count()); ++b) {
    factor_batch(grid_, b, mean_.rightCols(n_in_), factors_.data());
    finish_batch(b, factors_.data());
  }
  return estimate_;
}

// G_Z of [Y; U] to G^T in solved_ and B in b_; returns the condition of G_ur.
Lanes FastLpm::solve_indirect(const ComplexLanes* a) {
  const int n = n_in_;
  // G_ur^T G^T = G_yr^T and G_ur^T K^T = I, by the QR of G_ur^T.
  ComplexLanes* g_ur = small_.data();
  std::copy(g_z_.begin() + n * n_out_, g_z_.begin() + n * n_z_, g_ur);
  const Lanes norm = square_norm(g_ur, n * n);
  std::copy(g_z_.begin(), g_z_.begin() + n * n_out_, solved_.begin());
  unit(solved_.data() + n * n_out_, n);
  ComplexLanes* diagonal = g_ur + n * n;
  householder_factor(g_ur, n, n, diagonal);
  householder_apply(g_ur, n, n, solved_.data(), n_z_);
  back_substitute(g_ur, n, n, diagonal, 0, solved_.data(), n, n_z_);
  const ComplexLanes* k_t = solved_.data() + n * n_out_;
  const Lanes condition = (norm * square_norm(k_t, n * n)).sqrt();
  const Lanes regular = (diagonal_ratio(diagonal, n) < kSingular)
                            .select(condition, Lanes::Constant(std::numeric_limits<double>::infinity()));
  // B = K^T A conj(K), K = G_ur^-1
  for (int m = 0; m < n; ++m) {
    for (int j = 0; j < n; ++j) {
      ComplexLanes sum = zero_lanes();
      for (int s = 0; s < n; ++s) {
        ComplexLanes row = zero_lanes();
        for (int t = 0; t < n; ++t) add_product(row, k_t[t * n + j], a[s * n + t]);
        add_product_conj(sum, row, k_t[s * n + m]);
      }
      b_[index(m * n + j)] = sum;
    }
  }
  return regular;
}

// v = y - G u of the residuals e: C_V = v v^H / rows into c_v_, never negative, however much of the noise cancels.
void FastLpm::propagate(const ComplexLanes* g, const ComplexLanes* e, int stride, int rows, bool subtract) {
  for (int i = 0; i < n_out_; ++i) {
    for (int r = 0; r < rows; ++r) {
      ComplexLanes v = e[i * stride + r];
      for (int m = 0; subtract && m < n_in_; ++m) {
        const ComplexLanes& gain = g[i * n_in_ + m];
        const ComplexLanes& u = e[(n_out_ + m) * stride + r];
        v.re -= gain.re * u.re - gain.im * u.im;
        v.im -= gain.re * u.im + gain.im * u.re;
      }
      v_[index(i * rows + r)] = v;
    }
  }
  covariance(v_.data(), rows, rows, n_out_, 1.0 / rows, c_v_.data());
}

// Regression of one batch on factors that are known: estimate, covariances and B, then out of the lanes.
void FastLpm::finish_batch(int batch, const ComplexLanes* factors) {
  const FactorLayout layout(grid_);
  const int w_count = layout.window, p = layout.parameters, n = n_in_, q = grid_.q(), q_noise = grid_.q_noise();
  const bool is_indirect = estimate_.indirect;
  const int n_y = is_indirect ? n_z_ : n_out_;  // channels that are regressed
  for (int c = 0; c < n_y; ++c) gather(grid_, batch, mean_, c, z_.data() + c * w_count);
  householder_apply(factors, w_count, p, z_.data(), n_y);
  const ComplexLanes* residual = z_.data() + p;
  covariance(residual, w_count, q, n_y, 1.0 / q, c_z_.data());

  // G_Z^T = R33^-1 (Q^H Z^T)_last, n_in x n_y
  const ComplexLanes* inverse = factors + layout.inverse();
  for (int c = 0; c < n_y; ++c) {
    for (int j = 0; j < n; ++j) {
      ComplexLanes sum = zero_lanes();
      for (int m = j; m < n; ++m) add_product(sum, inverse[m * n + j], z_[index(c * w_count + p - n + m)]);
      g_z_[index(c * n + j)] = sum;
    }
  }
  const Lanes regressor_condition = diagonal_ratio(factors + layout.diagonal(), p);
  Lanes input_condition = Lanes::Ones();

  const ComplexLanes* a = factors + layout.a();
  ComplexLanes* g = g_z_.data();  // G^T, n_in x n_out
  if (is_indirect) {
    input_condition = solve_indirect(a);
    g = solved_.data();
  } else {
    std::copy(a, a + n * n, b_.begin());
  }

  const int lines = grid_.line_count();
  const auto store = [&](const std::vector<ComplexLanes>& from, MatrixStack<std::complex<double>>& to, int lane,
                         int k) {
    const int count = to.rows() * to.cols();
    for (int i = 0; i < count; ++i) to.data(k)[i] = {from[index(i)].re[lane], from[index(i)].im[lane]};
  };
  propagate(g, noise_.data() + batch * q_noise * n_z_, q_noise, q_noise, true);
  for (int lane = 0; lane < kLanes; ++lane) store(c_v_, estimate_.C_V_noise, lane, line_of(batch, lane, lines));
  propagate(g, residual, w_count, q, is_indirect);
  for (int lane = 0; lane < kLanes; ++lane) {
    const int k = line_of(batch, lane, lines);
    store(c_v_, estimate_.C_V, lane, k);
    store(c_z_, estimate_.C_Z, lane, k);
    store(b_, estimate_.B, lane, k);
    for (int i = 0; i < n_out_; ++i) {
      for (int j = 0; j < n; ++j) {
        estimate_.G.data(k)[j * n_out_ + i] = {g[i * n + j].re[lane], g[i * n + j].im[lane]};
      }
    }
    estimate_.regressor_condition[index(k)] = regressor_condition[lane];
    estimate_.input_condition[index(k)] = input_condition[lane];
    LineStatus status = LineStatus::ok;
    if (!(input_condition[lane] < kSingular)) status = LineStatus::singular_input;
    if (!(regressor_condition[lane] < kSingular)) status = LineStatus::singular_regressor;
    estimate_.status[index(k)] = status;
    if (status != LineStatus::ok) {
      estimate_.G[k].setZero();
      estimate_.B[k].setZero();
      estimate_.C_V[k].setZero();
      estimate_.C_Z[k].setZero();
      estimate_.C_V_noise[k].setZero();
    }
  }
}

LineSpectra spectra_at_lines(const LpmGrid& grid, const Eigen::Ref<const Eigen::MatrixXd>& samples) {
  FATMC_CHECK(samples.rows() == grid.total_samples(), "total_samples x channels");
  const RealDft dft(grid.total_samples());
  std::vector<std::complex<double>> bins(index(grid.bin_count()));
  LineSpectra spectra(grid.line_count(), samples.cols());
  for (Eigen::Index c = 0; c < samples.cols(); ++c) {
    dft.transform({samples.col(c).data(), index(grid.total_samples())}, bins);
    for (int k = 0; k < grid.line_count(); ++k) spectra(k, c) = bins[index(grid.bin(k))];
  }
  return spectra;
}

}  // namespace fatmc
