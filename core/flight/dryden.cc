#include "core/flight/dryden.h"

#include <cmath>
#include <complex>
#include <unsupported/Eigen/MatrixFunctions>

#include "core/base/check.h"
#include "core/flight/aircraft.h"

namespace fatmc {
namespace {

/// R(t) = pi delta(t): white noise whose one-sided PSD in w is 1 (variance = (1/2pi) W times the two-sided
/// integral).
constexpr double kNoiseIntensity = kPi;

/// Lower-triangular factor of a covariance; a pivot that is rounding alone becomes zero. Over one tick the
/// states of a chain are nearly dependent (conditional variances go with the fifth power of tick over time
/// constant).
template <int N>
Eigen::Matrix<double, N, N> semidefinite_factor(const Eigen::Matrix<double, N, N>& covariance) {
  Eigen::Matrix<double, N, N> factor = Eigen::Matrix<double, N, N>::Zero();
  for (int j = 0; j < N; ++j) {
    const double pivot = covariance(j, j) - factor.row(j).head(j).squaredNorm();
    if (pivot <= 1e-14 * covariance(j, j)) continue;
    factor(j, j) = std::sqrt(pivot);
    for (int i = j + 1; i < N; ++i) {
      factor(i, j) = (covariance(i, j) - factor.row(i).head(j).dot(factor.row(j).head(j))) / factor(j, j);
    }
  }
  return factor;
}

/// P of A P + P A' + b W b' = 0, by the Kronecker form (at most 9 x 9).
template <int N>
Eigen::Matrix<double, N, N> stationary_covariance(const Eigen::Matrix<double, N, N>& a,
                                                  const Eigen::Matrix<double, N, N>& noise) {
  Eigen::Matrix<double, N * N, N* N> system = Eigen::Matrix<double, N * N, N * N>::Zero();
  Eigen::Matrix<double, N * N, 1> right;
  for (int i = 0; i < N; ++i) {
    for (int j = 0; j < N; ++j) {
      right(i * N + j) = -noise(i, j);
      for (int m = 0; m < N; ++m) {
        system(i * N + j, m * N + j) += a(i, m);
        system(i * N + j, i * N + m) += a(j, m);
      }
    }
  }
  const Eigen::Matrix<double, N * N, 1> solution = system.fullPivLu().solve(right);
  Eigen::Matrix<double, N, N> p;
  for (int i = 0; i < N; ++i) {
    for (int j = 0; j < N; ++j) p(i, j) = solution(i * N + j);
  }
  return 0.5 * (p + p.transpose());
}

}  // namespace

double dryden_psd(int channel, double omega, double sigma, double airspeed, double span) {
  const double length = kDrydenLength;
  const auto square = [](double x) { return x * x; };
  const double reduced = square(length * omega / airspeed);
  const double transverse =
      square(sigma) * length / (kPi * airspeed) * (1.0 + 3.0 * reduced) / square(1.0 + reduced);
  const double wide = 1.0 + square(4.0 * span * omega / (kPi * airspeed));
  const double narrow = 1.0 + square(3.0 * span * omega / (kPi * airspeed));
  switch (channel) {
    case 0:
      return square(sigma) * 2.0 * length / (kPi * airspeed) / (1.0 + reduced);
    case 1:
    case 2:
      return transverse;
    case 3:
      return square(sigma) / (airspeed * length) * 0.8 * std::cbrt(kPi * length / (4.0 * span)) / wide;
    case 4:
      return square(omega / airspeed) / wide * transverse;
    case 5:
      return square(omega / airspeed) / narrow * transverse;
    default:
      break;
  }
  FATMC_CHECK(false, "a gust channel is 0 to 5");
}

template <int N>
Dryden::Chain<N> Dryden::discretise(const Eigen::Matrix<double, N, N>& a,
                                    const Eigen::Matrix<double, N, 1>& b, double tick_s) {
  // Van Loan (1978): exp([-A, G; 0, A'] h) = [., A_d^-1 Q_d; 0, A_d'] with G = b W b'.
  const Eigen::Matrix<double, N, N> noise = kNoiseIntensity * b * b.transpose();
  Eigen::Matrix<double, 2 * N, 2 * N> block = Eigen::Matrix<double, 2 * N, 2 * N>::Zero();
  block.template topLeftCorner<N, N>() = -a;
  block.template topRightCorner<N, N>() = noise;
  block.template bottomRightCorner<N, N>() = a.transpose();
  const Eigen::Matrix<double, 2 * N, 2 * N> power = (block * tick_s).eval().exp();
  Chain<N> chain;
  chain.transition = power.template bottomRightCorner<N, N>().transpose();
  const Eigen::Matrix<double, N, N> step = chain.transition * power.template topRightCorner<N, N>();
  chain.noise_factor = semidefinite_factor<N>(0.5 * (step + step.transpose()));
  chain.covariance = stationary_covariance<N>(a, noise);
  chain.start_factor = semidefinite_factor<N>(chain.covariance);
  return chain;
}

Dryden::Dryden(double sigma, double airspeed, double span, double tick_s) : tick_s_(tick_s) {
  FATMC_CHECK(sigma >= 0.0 && airspeed > 0.0 && span > 0.0 && tick_s > 0.0,
              "Dryden parameters are checked before");
  const double tau = kDrydenLength / airspeed;
  const double tau_q = 4.0 * span / (kPi * airspeed);
  const double tau_r = 3.0 * span / (kPi * airspeed);
  using Matrix1 = Eigen::Matrix<double, 1, 1>;

  // u: sigma sqrt(2L/(pi V)) / (1 + tau s)
  forward_ = discretise<1>(Matrix1(-1.0 / tau), Matrix1(sigma * std::sqrt(2.0 * tau / kPi) / tau), tick_s);
  // p: sqrt(0.8/(V L)) sigma (pi L/(4b))^(1/6) / (1 + tau_q s)
  const double roll_gain = sigma * std::sqrt(0.8 / (airspeed * kDrydenLength)) *
                           std::pow(kPi * kDrydenLength / (4.0 * span), 1.0 / 6.0);
  rolling_ = discretise<1>(Matrix1(-1.0 / tau_q), Matrix1(roll_gain / tau_q), tick_s);

  // v: g (1 + sqrt(3) tau s)/(1 + tau s)^2 as two lags x1, x2, v = g (sqrt(3) x1 + (1 - sqrt(3)) x2);
  // (s/V)/(1 + tau_r s) v = (v - x3)/(V tau_r) with x3 the lagged v.
  const double gain = sigma * std::sqrt(tau / kPi);
  const auto chain = [&](double lag) {
    Eigen::Matrix3d a;
    a << -1.0 / tau, 0.0, 0.0,  //
        1.0 / tau, -1.0 / tau, 0.0, std::sqrt(3.0) / lag, (1.0 - std::sqrt(3.0)) / lag, -1.0 / lag;
    return discretise<3>(a, Eigen::Vector3d(1.0 / tau, 0.0, 0.0), tick_s);
  };
  const auto output = [&](double lag, double sign) {
    Eigen::Matrix<double, 2, 3> c;
    c << std::sqrt(3.0), 1.0 - std::sqrt(3.0), 0.0, std::sqrt(3.0), 1.0 - std::sqrt(3.0), -1.0;
    c.row(0) *= gain;
    c.row(1) *= sign * gain / (airspeed * lag);
    return c;
  };
  side_ = chain(tau_r);
  vertical_ = chain(tau_q);
  side_output_ = output(tau_r, 1.0);
  vertical_output_ = output(tau_q, -1.0);
}

namespace {

/// x <- A x + F n, n standard normal; A and F lower triangular, stored by columns.
template <int N>
inline void step_chain(const Eigen::Matrix<double, N, N>& transition,
                       const Eigen::Matrix<double, N, N>& factor, double* x, RandomStream& random) {
  const double* const a = transition.data();
  const double* const f = factor.data();
  double normal[N];
  for (double& value : normal) value = random.normal();
  for (int i = N - 1; i >= 0; --i) {  // from below: x above is still old
    double sum = 0.0;
    for (int j = 0; j <= i; ++j) sum += a[N * j + i] * x[j] + f[N * j + i] * normal[j];
    x[i] = sum;
  }
}

}  // namespace

Dryden::StateVector Dryden::start(RandomStream& random) const {
  StateVector x{};
  step_chain<1>(forward_.transition, forward_.start_factor, &x[0], random);
  step_chain<3>(side_.transition, side_.start_factor, &x[1], random);
  step_chain<3>(vertical_.transition, vertical_.start_factor, &x[4], random);
  step_chain<1>(rolling_.transition, rolling_.start_factor, &x[7], random);
  return x;
}

void Dryden::advance(StateVector& x, RandomStream& random) const {
  step_chain<1>(forward_.transition, forward_.noise_factor, &x[0], random);
  step_chain<3>(side_.transition, side_.noise_factor, &x[1], random);
  step_chain<3>(vertical_.transition, vertical_.noise_factor, &x[4], random);
  step_chain<1>(rolling_.transition, rolling_.noise_factor, &x[7], random);
}

Dryden::Gusts Dryden::gusts(const StateVector& x) const {
  const auto row = [](const Eigen::Matrix<double, 2, 3>& c, int i, const double* s) {
    const double* const at = c.data() + i;  // stored by columns of two
    return at[0] * s[0] + at[2] * s[1] + at[4] * s[2];
  };
  return {x[0], row(side_output_, 0, &x[1]),     row(vertical_output_, 0, &x[4]),
          x[7], row(vertical_output_, 1, &x[4]), row(side_output_, 1, &x[1])};
}

Eigen::Matrix<double, 6, 6> Dryden::covariance() const {
  Eigen::Matrix<double, 6, 6> out = Eigen::Matrix<double, 6, 6>::Zero();
  out(0, 0) = forward_.covariance(0, 0);
  out(3, 3) = rolling_.covariance(0, 0);
  const Eigen::Matrix2d side = side_output_ * side_.covariance * side_output_.transpose();
  const Eigen::Matrix2d vertical = vertical_output_ * vertical_.covariance * vertical_output_.transpose();
  const std::array<int, 2> vr = {1, 5};
  const std::array<int, 2> wq = {2, 4};
  for (int i = 0; i < 2; ++i) {
    for (int j = 0; j < 2; ++j) {
      out(vr[i], vr[j]) = side(i, j);
      out(wq[i], wq[j]) = vertical(i, j);
    }
  }
  return out;
}

double Dryden::sampled_psd(int channel, double omega) const {
  using Complex = std::complex<double>;
  const Complex z = std::polar(1.0, omega * tick_s_);
  // |c (zI - A)^-1 F|^2, as one-sided density in w: T/pi of the variance of a white sequence.
  const auto density = [&](const auto& chain, const auto& c) {
    constexpr int n = std::decay_t<decltype(c)>::ColsAtCompileTime;
    Eigen::Matrix<Complex, n, n> pencil = -chain.transition.template cast<Complex>();
    pencil.diagonal().array() += z;
    const Eigen::Matrix<Complex, 1, n> h =
        c.template cast<Complex>() * pencil.inverse() * chain.noise_factor.template cast<Complex>();
    return h.squaredNorm() * tick_s_ / kPi;
  };
  using Row1 = Eigen::Matrix<double, 1, 1>;
  using Row3 = Eigen::Matrix<double, 1, 3>;
  switch (channel) {
    case 0:
      return density(forward_, Row1(1.0));
    case 1:
      return density(side_, Row3(side_output_.row(0)));
    case 2:
      return density(vertical_, Row3(vertical_output_.row(0)));
    case 3:
      return density(rolling_, Row1(1.0));
    case 4:
      return density(vertical_, Row3(vertical_output_.row(1)));
    case 5:
      return density(side_, Row3(side_output_.row(1)));
    default:
      break;
  }
  FATMC_CHECK(false, "a gust channel is 0 to 5");
}

}  // namespace fatmc
