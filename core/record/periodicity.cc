#include "core/record/periodicity.h"

#include <algorithm>
#include <cmath>
#include <complex>

#include "core/base/check.h"
#include "core/base/text.h"
#include "core/signal/dft.h"

namespace fatmc {
namespace {

std::size_t index(Eigen::Index i) { return static_cast<std::size_t>(i); }

/// sum_n x[n] x[n + lag] for lag = 0 ... n/2, by a DFT padded to 2^k >= 3n/2.
std::vector<double> autocorrelation(const Eigen::Ref<const Eigen::VectorXd>& x) {
  const Eigen::Index n = x.size();
  int length = 4;
  while (length < n + n / 2 + 1) length *= 2;
  std::vector<double> padded(index(length), 0.0);
  for (Eigen::Index i = 0; i < n; ++i) padded[index(i)] = x(i);
  std::vector<std::complex<double>> bins(index(length / 2 + 1));
  RealDft(length).transform(padded, bins);
  for (auto& b : bins) b = std::norm(b);
  inverse_real_dft(bins, padded);
  padded.resize(index(n / 2 + 1));
  for (double& value : padded) value *= std::sqrt(static_cast<double>(length));
  return padded;
}

/// repetition_error for all lags up to half the record.
std::vector<double> repetition_errors(const Eigen::Ref<const Eigen::MatrixXd>& x) {
  const Eigen::Index n = x.rows();
  std::vector<double> error(index(n / 2 + 1), 0.0);
  for (Eigen::Index c = 0; c < x.cols(); ++c) {
    const Eigen::VectorXd centred = x.col(c).array() - x.col(c).mean();
    const double variance = centred.squaredNorm() / static_cast<double>(n);
    const std::vector<double> product = autocorrelation(centred);
    // sum (x[n+lag] - x[n])^2 = sum of the squares without the last and without the first lag samples - 2 product
    double without_last = centred.squaredNorm(), without_first = without_last;
    for (Eigen::Index lag = 0; lag <= n / 2; ++lag) {
      const double sum = without_last + without_first - 2.0 * product[index(lag)];
      error[index(lag)] += std::max(0.0, sum) / (2.0 * variance * static_cast<double>((n - lag) * x.cols()));
      without_first -= centred(lag) * centred(lag);
      without_last -= centred(n - 1 - lag) * centred(n - 1 - lag);
    }
  }
  return error;
}

}  // namespace

double repetition_error(const Eigen::Ref<const Eigen::MatrixXd>& x, int period) {
  FATMC_CHECK(period >= 1 && period < x.rows(), "a period shorter than the record");
  double error = 0.0;
  for (Eigen::Index c = 0; c < x.cols(); ++c) {
    const double variance = (x.col(c).array() - x.col(c).mean()).square().mean();
    const Eigen::Index overlap = x.rows() - period;
    error += (x.col(c).tail(overlap) - x.col(c).head(overlap)).squaredNorm() /
             (2.0 * variance * static_cast<double>(overlap * x.cols()));
  }
  return error;
}

int find_period(const Eigen::Ref<const Eigen::MatrixXd>& x) {
  if (x.rows() < 6) return 0;
  const std::vector<double> error = repetition_errors(x);
  // Neighbouring samples of a smooth signal are alike: look only behind the first lag at which it has forgotten itself.
  const auto forgotten = std::find_if(error.begin(), error.end(), [](double e) { return e > 0.5; });
  if (forgotten == error.end()) return 0;
  const double best = *std::min_element(forgotten, error.end());
  if (best > 0.05) return 0;
  // The error of whole multiples of the period is the noise, the same for all of them; 1e-9 is the round-off of the
  // DFT behind it.
  const double threshold = std::max(2.0 * best, 1e-9);
  auto lag = std::find_if(forgotten, error.end(), [&](double e) { return e <= threshold; });
  while (lag + 1 != error.end() && *(lag + 1) < *lag) ++lag;
  return static_cast<int>(lag - error.begin());
}

Result<std::vector<int>> find_excited_lines(const Eigen::Ref<const Eigen::MatrixXd>& x, int period) {
  FATMC_CHECK(period >= 3 && x.rows() >= period, "at least one period");
  const Eigen::Index periods = x.rows() / period;
  const int highest = (period - 1) / 2;
  std::vector<double> magnitude(index(highest + 1), 0.0);
  std::vector<std::complex<double>> bins(index(highest + 1));
  const RealDft dft(period);
  for (Eigen::Index c = 0; c < x.cols(); ++c) {
    Eigen::VectorXd mean = Eigen::VectorXd::Zero(period);
    for (Eigen::Index p = 0; p < periods; ++p) mean += x.col(c).segment(p * period, period);
    dft.transform({mean.data(), index(period)}, bins);
    double largest = 0.0;
    for (int k = 1; k <= highest; ++k) largest = std::max(largest, std::abs(bins[index(k)]));
    if (largest == 0.0) continue;
    for (int k = 1; k <= highest; ++k) {
      magnitude[index(k)] = std::max(magnitude[index(k)], std::abs(bins[index(k)]) / largest);
    }
  }
  constexpr double kFloor = 1e-5, kStep = 5.0;
  std::vector<double> sorted(magnitude.begin() + 1, magnitude.end());
  for (double& value : sorted) value = std::max(value, kFloor);
  std::sort(sorted.begin(), sorted.end(), std::greater<>());
  double widest = 0.0, threshold = 0.0;
  for (std::size_t i = 0; i + 1 < sorted.size(); ++i) {
    // The few smallest magnitudes of noise lie far apart: a step counts with at least 8 lines below it, or none at all.
    const bool counts = sorted[i + 1] == kFloor || sorted.size() - i - 1 >= 8;
    if (counts && sorted[i] / sorted[i + 1] > widest) {
      widest = sorted[i] / sorted[i + 1];
      threshold = sorted[i];
    }
  }
  if (widest < kStep) {
    return fail("the excited lines do not stand out of the spectrum of the excitation (widest step a factor " +
                significant(widest, 3) + "), give excited_lines");
  }
  std::vector<int> lines;
  for (int k = 1; k <= highest; ++k) {
    if (magnitude[index(k)] >= threshold) lines.push_back(k);
  }
  return lines;
}

}  // namespace fatmc
