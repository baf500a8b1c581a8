#include "core/signal/sliding_dft.h"

#include <cmath>
#include <numbers>
#include <utility>

#include "core/base/check.h"

namespace fatmc {
namespace {

std::size_t index(std::int64_t i) { return static_cast<std::size_t>(i); }

}  // namespace

SlidingDft::SlidingDft(int window_samples, std::vector<int> bins, int channels)
    : window_samples_(window_samples),
      channels_(channels),
      bins_(std::move(bins)),
      step_(bins_.size(), 0),
      twiddle_(index(window_samples)),
      window_(index(window_samples) * index(channels), 0.0),
      sum_re_(Eigen::ArrayXXd::Zero(static_cast<Eigen::Index>(bins_.size()), channels)),
      sum_im_(sum_re_),
      turn_re_(static_cast<Eigen::Index>(bins_.size())),
      turn_im_(turn_re_),
      change_(channels),
      dft_(window_samples) {
  FATMC_CHECK(channels >= 1, "at least one channel");
  for (const int bin : bins_)
    FATMC_CHECK(bin >= 0 && bin <= window_samples / 2, "bins up to half the window");
  for (int i = 0; i < window_samples; ++i) {
    twiddle_[index(i)] = std::polar(1.0, -2.0 * std::numbers::pi * i / window_samples);
  }
}

void SlidingDft::push(std::span<const double> sample) {
  FATMC_CHECK(sample.size() == index(channels_), "a value of every channel");
  const std::int64_t at = count_ % window_samples_;
  for (int c = 0; c < channels_; ++c) {
    double& oldest = window_[index(c) * index(window_samples_) + index(at)];
    change_(c) = sample[index(c)] - oldest;
    oldest = sample[index(c)];
  }
  ++count_;
  if (at == window_samples_ - 1) {  // the ring is in order: the moment for a fresh start
    refresh();
    return;
  }
  for (std::size_t k = 0; k < bins_.size(); ++k) {
    const std::complex<double> w = twiddle_[index(step_[k])];
    turn_re_(static_cast<Eigen::Index>(k)) = w.real();
    turn_im_(static_cast<Eigen::Index>(k)) = w.imag();
    step_[k] += bins_[k];
    if (step_[k] >= window_samples_) step_[k] -= window_samples_;
  }
  // Over the bins, of which there are hundreds: long vectors, where channels would give short ones.
  for (int c = 0; c < channels_; ++c) {
    sum_re_.col(c) += change_(c) * turn_re_;
    sum_im_.col(c) += change_(c) * turn_im_;
  }
}

void SlidingDft::refresh() {
  std::vector<std::complex<double>> spectrum(index(window_samples_ / 2 + 1));
  const double scale = std::sqrt(static_cast<double>(window_samples_));
  for (int c = 0; c < channels_; ++c) {
    const std::span<const double> samples(window_.data() + index(c) * index(window_samples_),
                                          index(window_samples_));
    dft_.transform(samples, spectrum);
    for (std::size_t k = 0; k < bins_.size(); ++k) {
      const std::complex<double> sum = scale * spectrum[index(bins_[k])];
      sum_re_(static_cast<Eigen::Index>(k), c) = sum.real();
      sum_im_(static_cast<Eigen::Index>(k), c) = sum.imag();
    }
  }
  for (int& step : step_) step = 0;  // the next sample stands at a multiple of N
}

/// N^(-1/2) exp(j 2 pi k n0 / N), n0 = count mod N.
std::complex<double> SlidingDft::turn(std::size_t k) const {
  const std::int64_t phase =
      static_cast<std::int64_t>(bins_[k]) * (count_ % window_samples_) % window_samples_;
  return std::conj(twiddle_[index(phase)]) / std::sqrt(static_cast<double>(window_samples_));
}

void SlidingDft::spectrum(Eigen::Ref<Eigen::MatrixXcd> out) const {
  FATMC_CHECK(out.rows() == sum_re_.rows() && out.cols() == channels_, "bins x channels");
  for (std::size_t k = 0; k < bins_.size(); ++k) {
    const std::complex<double> w = turn(k);
    const auto row = static_cast<Eigen::Index>(k);
    for (int c = 0; c < channels_; ++c)
      out(row, c) = w * std::complex<double>(sum_re_(row, c), sum_im_(row, c));
  }
}

void SlidingDft::spectrum_at_bins(Eigen::Ref<Eigen::MatrixXcd> out) const {
  FATMC_CHECK(out.rows() > (bins_.empty() ? -1 : bins_.back()) && out.cols() == channels_,
              "rows up to the last bin");
  for (std::size_t k = 0; k < bins_.size(); ++k) {
    const std::complex<double> w = turn(k);
    const auto row = static_cast<Eigen::Index>(k);
    for (int c = 0; c < channels_; ++c)
      out(bins_[k], c) = w * std::complex<double>(sum_re_(row, c), sum_im_(row, c));
  }
}

}  // namespace fatmc
