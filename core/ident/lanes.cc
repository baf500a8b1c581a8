#include "core/ident/lanes.h"

namespace fatmc {
namespace {

// H z for `kColumns` columns at once: real and imaginary products keep separate sums, so that enough independent
// multiply-adds are in flight to hide their latency.
template <int kColumns>
void reflect(const ComplexLanes* w, int length, ComplexLanes* z, int stride) {
  Lanes rr[kColumns], ii[kColumns], ri[kColumns], ir[kColumns];
  for (int c = 0; c < kColumns; ++c) rr[c] = ii[c] = ri[c] = ir[c] = Lanes::Zero();
  for (int r = 0; r < length; ++r) {
    for (int c = 0; c < kColumns; ++c) {
      const ComplexLanes& v = z[c * stride + r];
      rr[c] += w[r].re * v.re;
      ii[c] += w[r].im * v.im;
      ri[c] += w[r].re * v.im;
      ir[c] += w[r].im * v.re;
    }
  }
  for (int c = 0; c < kColumns; ++c) {  // w^H z
    rr[c] += ii[c];
    ri[c] -= ir[c];
  }
  for (int r = 0; r < length; ++r) {
    for (int c = 0; c < kColumns; ++c) {
      ComplexLanes& v = z[c * stride + r];
      v.re -= w[r].re * rr[c] - w[r].im * ri[c];
      v.im -= w[r].re * ri[c] + w[r].im * rr[c];
    }
  }
}

void reflect_columns(const ComplexLanes* w, int length, ComplexLanes* z, int stride, int columns) {
  int c = 0;
  for (; c + 3 <= columns; c += 3) reflect<3>(w, length, z + c * stride, stride);
  if (columns - c == 2) reflect<2>(w, length, z + c * stride, stride);
  if (columns - c == 1) reflect<1>(w, length, z + c * stride, stride);
}

/// Reflector of one column, in place; returns R(j, j). With x its part from the diagonal on, |x| its norm and
/// e the phase of x_0: R(j, j) = -e |x|, v = x - R(j, j) e_1, H = I - v v^H / (|x| (|x| + |x_0|)).
ComplexLanes make_reflector(ComplexLanes* x, int length) {
  Lanes square = Lanes::Zero();
  for (int r = 0; r < length; ++r) square += x[r].re * x[r].re + x[r].im * x[r].im;
  const Lanes norm = square.sqrt();
  const Lanes head = (x[0].re * x[0].re + x[0].im * x[0].im).sqrt();
  const Lanes phase_re = (head > 0.0).select(x[0].re / head, Lanes::Ones());
  const Lanes phase_im = (head > 0.0).select(x[0].im / head, Lanes::Zero());
  x[0].re += phase_re * norm;
  x[0].im += phase_im * norm;
  const Lanes tau = norm * (norm + head);
  const Lanes scale = (tau > 0.0).select(tau.sqrt().inverse(), Lanes::Zero());
  for (int r = 0; r < length; ++r) {
    x[r].re *= scale;
    x[r].im *= scale;
  }
  return {-phase_re * norm, -phase_im * norm};
}

}  // namespace

void householder_factor(ComplexLanes* x, int rows, int cols, ComplexLanes* diagonal) {
  for (int j = 0; j < cols; ++j) {
    ComplexLanes* w = x + j * rows + j;
    diagonal[j] = make_reflector(w, rows - j);
    reflect_columns(w, rows - j, w + rows, rows, cols - j - 1);
  }
}

void householder_apply(const ComplexLanes* x, int rows, int cols, ComplexLanes* z, int z_cols) {
  for (int j = 0; j < cols; ++j) reflect_columns(x + j * rows + j, rows - j, z + j, rows, z_cols);
}

void back_substitute(const ComplexLanes* x, int rows, int cols, const ComplexLanes* diagonal, int first,
                     ComplexLanes* z, int z_rows, int z_cols) {
  for (int i = cols - 1; i >= first; --i) {
    const ComplexLanes& d = diagonal[i];
    const Lanes square = d.re * d.re + d.im * d.im;
    const Lanes inverse = (square > 0.0).select(square.inverse(), Lanes::Zero());
    for (int c = 0; c < z_cols; ++c) {
      ComplexLanes* column = z + c * z_rows;
      ComplexLanes rest = column[i - first];
      for (int k = i + 1; k < cols; ++k) {
        const ComplexLanes& r = x[k * rows + i];
        const ComplexLanes& s = column[k - first];
        rest.re -= r.re * s.re - r.im * s.im;
        rest.im -= r.re * s.im + r.im * s.re;
      }
      column[i - first] = {(rest.re * d.re + rest.im * d.im) * inverse, (rest.im * d.re - rest.re * d.im) * inverse};
    }
  }
}

void covariance(const ComplexLanes* e, int stride, int rows, int cols, double scale, ComplexLanes* c) {
  for (int b = 0; b < cols; ++b) {
    for (int a = b; a < cols; ++a) {
      const ComplexLanes* x = e + a * stride;
      const ComplexLanes* y = e + b * stride;
      Lanes rr = Lanes::Zero(), ii = Lanes::Zero(), ri = Lanes::Zero(), ir = Lanes::Zero();
      for (int r = 0; r < rows; ++r) {
        rr += x[r].re * y[r].re;
        ii += x[r].im * y[r].im;
        ir += x[r].im * y[r].re;
        ri += x[r].re * y[r].im;
      }
      const ComplexLanes value{(rr + ii) * scale, a == b ? Lanes(Lanes::Zero()) : Lanes((ir - ri) * scale)};
      c[b * cols + a] = value;
      c[a * cols + b] = {value.re, -value.im};
    }
  }
}

}  // namespace fatmc
