// Spectra of a made-up periodic experiment, bin by bin, so that tests know every term of them.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/LU>
#include <cmath>
#include <complex>
#include <functional>
#include <numbers>
#include <vector>

#include "core/ident/fast_lpm.h"
#include "core/random/random_stream.h"

namespace fatmc::test {

using Complex = std::complex<double>;
using Response = std::function<Eigen::MatrixXcd(double frequency_hz)>;

inline std::vector<int> consecutive_lines(int first, int count) {
  std::vector<int> lines;
  for (int i = 0; i < count; ++i) lines.push_back(first + i);
  return lines;
}

inline LpmGrid make_grid(std::vector<int> lines, int n_in, LpmOptions options = {}, int periods = 2) {
  auto grid = LpmGrid::create({std::move(lines), 10'000, periods, 50.0}, options, n_in);
  if (!grid) throw std::runtime_error(grid.error().text());
  return *grid;
}

/// Circular complex normal of unit variance.
inline Complex complex_normal(RandomStream& stream) {
  const double re = stream.normal();
  return Complex(re, stream.normal()) * std::numbers::sqrt2 * 0.5;
}

/// Unit-magnitude references of random phase, line_count x n_in.
inline LineSpectra random_phases(const LpmGrid& grid, RandomStream& stream) {
  LineSpectra reference(grid.line_count(), grid.n_in());
  for (Eigen::Index k = 0; k < reference.rows(); ++k) {
    for (Eigen::Index j = 0; j < reference.cols(); ++j) {
      reference(k, j) = std::polar(1.0, 2.0 * std::numbers::pi * stream.uniform());
    }
  }
  return reference;
}

struct Spectra {
  Eigen::MatrixXcd outputs, inputs;  ///< bin_count x channels
};

/// U = G_ur R, Y = G U at the excited bins, and noise of covariance mixing mixing^H at every bin.
inline Spectra closed_loop(const LpmGrid& grid, const LineSpectra& reference, const Response& g, const Response& g_ur,
                           const Eigen::MatrixXcd& mixing, int n_out, RandomStream& stream) {
  const int n_in = grid.n_in();
  Eigen::MatrixXcd z(grid.bin_count(), n_out + n_in);
  Eigen::VectorXcd white(n_out + n_in);
  for (Eigen::Index m = 0; m < z.rows(); ++m) {
    for (auto& w : white) w = complex_normal(stream);
    z.row(m) = (mixing * white).transpose();
  }
  for (int k = 0; k < grid.line_count(); ++k) {
    const Eigen::VectorXcd u = g_ur(grid.frequency_hz(k)) * reference.row(k).transpose();
    z.row(grid.bin(k)).tail(n_in) += u.transpose();
    z.row(grid.bin(k)).head(n_out) += (g(grid.frequency_hz(k)) * u).transpose();
  }
  return {z.leftCols(n_out), z.rightCols(n_in)};
}

/// Polynomial in frequency with random complex matrix coefficients, of `degree`, around 1 Hz.
inline Response random_polynomial(int rows, int cols, int degree, RandomStream& stream, double diagonal = 2.0) {
  std::vector<Eigen::MatrixXcd> coefficients;
  for (int g = 0; g <= degree; ++g) {
    Eigen::MatrixXcd c(rows, cols);
    for (auto& value : c.reshaped()) value = complex_normal(stream) * 0.5;
    if (g == 0) {
      for (int i = 0; i < std::min(rows, cols); ++i) c(i, i) += diagonal;
    }
    coefficients.push_back(c);
  }
  return [coefficients](double f) {
    Eigen::MatrixXcd value = coefficients.back();
    for (std::size_t g = coefficients.size() - 1; g-- > 0;) value = value * (f - 1.0) + coefficients[g];
    return value;
  };
}

inline Eigen::MatrixXcd random_mixing(int n, double size, RandomStream& stream) {
  Eigen::MatrixXcd mixing(n, n);
  for (auto& value : mixing.reshaped()) value = size * complex_normal(stream);
  return mixing;
}

}  // namespace fatmc::test
