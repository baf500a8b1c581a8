// Forward-mode automatic differentiation: a value and its derivatives with respect to N variables.
//
//   f(a + sum_i e_i da_i) = f(a) + sum_i e_i f'(a) da_i,   e_i e_j = 0
//
// The equations of motion are templates over their scalar, so that Jacobians are exact to rounding and cannot
// disagree with what is flown.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace fatmc {

template <std::size_t N>
struct Dual {
  double value = 0.0;
  std::array<double, N> slope{};

  Dual() = default;
  Dual(double v) : value(v) {}  // NOLINT: a constant is a dual without slope
  /// The i-th variable itself.
  Dual(double v, std::size_t i) : value(v) { slope[i] = 1.0; }

  Dual& operator+=(const Dual& b) { return *this = *this + b; }
  Dual& operator-=(const Dual& b) { return *this = *this - b; }
  Dual& operator*=(const Dual& b) { return *this = *this * b; }

  /// f(a) with known f' at a.
  [[nodiscard]] Dual chain(double f, double derivative) const {
    Dual out(f);
    for (std::size_t i = 0; i < N; ++i) out.slope[i] = derivative * slope[i];
    return out;
  }
  friend Dual operator+(const Dual& a, const Dual& b) { return linear(a.value + b.value, 1.0, a, 1.0, b); }
  friend Dual operator-(const Dual& a, const Dual& b) { return linear(a.value - b.value, 1.0, a, -1.0, b); }
  friend Dual operator*(const Dual& a, const Dual& b) {
    return linear(a.value * b.value, b.value, a, a.value, b);
  }
  friend Dual operator/(const Dual& a, const Dual& b) {
    const double quotient = a.value / b.value;
    return linear(quotient, 1.0 / b.value, a, -quotient / b.value, b);
  }
  friend Dual operator-(const Dual& a) { return a.chain(-a.value, -1.0); }
  friend bool operator<(const Dual& a, const Dual& b) { return a.value < b.value; }
  friend bool operator>(const Dual& a, const Dual& b) { return a.value > b.value; }

  friend Dual sqrt(const Dual& a) {
    const double root = std::sqrt(a.value);
    return a.chain(root, 0.5 / root);
  }
  friend Dual atan(const Dual& a) { return a.chain(std::atan(a.value), 1.0 / (1.0 + a.value * a.value)); }
  friend Dual sin(const Dual& a) { return a.chain(std::sin(a.value), std::cos(a.value)); }
  friend Dual cos(const Dual& a) { return a.chain(std::cos(a.value), -std::sin(a.value)); }
  friend Dual asin(const Dual& a) {
    return a.chain(std::asin(a.value), 1.0 / std::sqrt(1.0 - a.value * a.value));
  }
  friend Dual atan2(const Dual& y, const Dual& x) {
    const double r2 = x.value * x.value + y.value * y.value;
    return linear(std::atan2(y.value, x.value), x.value / r2, y, -y.value / r2, x);
  }

 private:
  static Dual linear(double value, double ka, const Dual& a, double kb, const Dual& b) {
    Dual out(value);
    for (std::size_t i = 0; i < N; ++i) out.slope[i] = ka * a.slope[i] + kb * b.slope[i];
    return out;
  }
};

}  // namespace fatmc
