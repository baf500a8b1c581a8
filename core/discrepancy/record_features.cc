#include "core/discrepancy/record_features.h"

#include <Eigen/LU>
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <span>

#include "core/base/check.h"
#include "core/flight/aircraft.h"

namespace fatmc {
namespace {

/// Columns of a record in the order of FeatureLayout::channels.
std::span<const double> channel(const LoopRecord& record, int c, bool attitude) {
  const auto column = [](const auto& m, int j) {
    return std::span<const double>(m.col(j).data(), static_cast<std::size_t>(m.rows()));
  };
  if (c < 3) return column(record.output, c);
  if (attitude && c < 5) return column(record.attitude, c - 3);
  return column(record.airspeed, 0);
}

/// log(samples / distinct values): 0 where no value repeats. Distinct bit patterns are counted in a table with open
/// addressing, a fifth full at most: sorting would take longer than the flight. Zeros of either sign are one value.
double repetition(std::span<const double> x) {
  constexpr std::uint64_t kEmpty = ~std::uint64_t{0};  // a NaN, which no record holds
  const auto bits = static_cast<unsigned>(std::bit_width(x.size())) + 2;
  std::vector<std::uint64_t> table(std::size_t{1} << bits, kEmpty);
  const std::uint64_t mask = table.size() - 1;
  std::size_t distinct = 0;
  for (const double value : x) {
    const auto pattern = std::bit_cast<std::uint64_t>(value + 0.0);
    std::uint64_t at = (pattern * 0x9e3779b97f4a7c15ULL) >> (64 - bits);
    while (table[at] != kEmpty && table[at] != pattern) at = (at + 1) & mask;
    if (table[at] == pattern) continue;
    table[at] = pattern;
    ++distinct;
  }
  return std::log(static_cast<double>(x.size()) / static_cast<double>(distinct));
}

struct BandPower {
  double sum = 0.0, largest = 0.0;
  int count = 0;
  void add(double power) {
    sum += power;
    largest = std::max(largest, power);
    ++count;
  }
};

constexpr double kLeastPower = 1e-300;  // the log of a channel that stands still stays finite

}  // namespace

void level_ends(std::span<const double> x, std::vector<double>& out) {
  const double slope = (x.back() - x.front()) / static_cast<double>(x.size() - 1);
  const double middle = 0.5 * static_cast<double>(x.size() - 1);
  out.resize(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) out[i] = x[i] - slope * (static_cast<double>(i) - middle);
}

FeatureExtractor FeatureExtractor::with(std::shared_ptr<const MomentFilters> filters) const {
  FeatureExtractor out = *this;
  out.layout_ = layout_.with_moments(filters->moments);
  out.filters_ = std::move(filters);
  return out;
}

FeatureExtractor::FeatureExtractor(FeatureLayout layout, const Eigen::Vector3d& gain)
    : layout_(std::move(layout)),
      gain_(gain),
      dft_(layout_.experiment.period_samples * layout_.experiment.periods),
      windows_(layout_.experiment.lines, layout_.experiment.period_samples, layout_.experiment.periods,
               FeatureLayout::kTransientBins, FeatureLayout::kTransientOrder),
      excited_(static_cast<std::size_t>(layout_.experiment.period_samples / 2 + 1), 0) {
  for (const int line : layout_.experiment.lines) excited_[static_cast<std::size_t>(line)] = 1;
}

Eigen::VectorXd FeatureExtractor::extract(const LoopRecord& record) const {
  FATMC_CHECK(record.output.rows() == dft_.size(), "a record of the experiment's length");
  FATMC_CHECK(record.has_attitude() || !layout_.attitude, "the layout's channels");
  FATMC_CHECK(record.has_airspeed() || !layout_.airspeed, "the layout's channels");
  Eigen::VectorXd out(layout_.size);
  spectra(record, out);
  for (const FeatureBlock& block : layout_.blocks) {
    if (block.kind == FeatureKind::lattice) {
      for (int c = 0; c < 3; ++c) out[block.first + c] = repetition(channel(record, c, layout_.attitude));
    }
    if (block.kind == FeatureKind::dc && layout_.attitude) {
      // sin tan = 1/cos - cos
      const Eigen::ArrayXd cosine = record.attitude.col(0).array().cos();
      out[block.first + block.size() - 1] = (cosine.inverse() - cosine).mean();
    }
    if (block.kind == FeatureKind::controller) controller(record, out.data() + block.first);
  }
  return out;
}

void FeatureExtractor::spectra(const LoopRecord& record, Eigen::VectorXd& out) const {
  const int n = dft_.size();
  const int periods = layout_.experiment.periods;
  const double bin_hz = layout_.experiment.rate_hz / n;
  std::vector<std::complex<double>> bins(static_cast<std::size_t>(n / 2 + 1));
  std::vector<double> samples;
  const Eigen::Index moments = filters_ == nullptr ? 0 : static_cast<Eigen::Index>(filters_->moments.size());
  if (moments > 0) out.tail(moments).setZero();  // the layout's last block
  for (int c = 0; c < static_cast<int>(layout_.channels.size()); ++c) {
    level_ends(channel(record, c, layout_.attitude), samples);
    dft_.transform(samples, bins);
    for (Eigen::Index i = 0; c < 3 && i < moments; ++i) {
      const auto weight = filters_->weights[static_cast<std::size_t>(i)].col(c);
      double& sum = out[layout_.size - moments + i];
      for (std::size_t b = 0; b < filters_->bins.size(); ++b) {
        const std::complex<double> w = weight[static_cast<Eigen::Index>(b)];
        const std::complex<double> y = bins[static_cast<std::size_t>(filters_->bins[b])];
        sum += w.real() * y.real() + w.imag() * y.imag();
      }
    }
    for (const FeatureBlock& block : layout_.blocks) {
      const auto at = std::find(block.channels.begin(), block.channels.end(), c);
      if (at == block.channels.end()) continue;
      const auto place = block.first + (at - block.channels.begin());
      if (block.kind == FeatureKind::line) {
        const int k = block.line;
        std::complex<double> y =
            bins[static_cast<std::size_t>(periods * layout_.experiment.lines[static_cast<std::size_t>(k)])];
        for (int i = 0; windows_.line_count() > 0 && i < windows_.count(); ++i) {
          const auto w = static_cast<std::size_t>(i);
          y -= windows_.weights(k)[w] * bins[static_cast<std::size_t>(windows_.bins(k)[w])];
        }
        out[place] = y.real();
        out[place + static_cast<Eigen::Index>(block.channels.size())] = y.imag();
      } else if (block.kind == FeatureKind::dc) {
        out[place] = bins[0].real() / std::sqrt(static_cast<double>(n));
      } else if (block.kind == FeatureKind::noise || block.kind == FeatureKind::peak ||
                 block.kind == FeatureKind::distortion) {
        const bool harmonics = block.kind == FeatureKind::distortion;
        BandPower band;
        const int last = std::min(static_cast<int>(std::floor(block.high_hz / bin_hz)), (n - 1) / 2);
        for (int m = static_cast<int>(std::floor(block.low_hz / bin_hz)) + 1; m <= last; ++m) {
          const bool harmonic = m % periods == 0;
          if (harmonic != harmonics || (harmonic && excited_[static_cast<std::size_t>(m / periods)] != 0))
            continue;
          band.add(std::norm(bins[static_cast<std::size_t>(m)]));
        }
        const double mean = std::max(kLeastPower, band.sum / std::max(1, band.count));
        out[place] = block.kind == FeatureKind::peak ? std::log(std::max(kLeastPower, band.largest) / mean)
                                                     : std::log(mean);
      }
    }
  }
}

// u_i = k_i (r_i - y_i) + o_i (+ c t on yaw, t the turn coordinator's rate) by least squares; with exact logs it fits to the
// last digit, so that changed gains and trim offsets stand out however weak the excitation is.
void FeatureExtractor::controller(const LoopRecord& record, double* out) const {
  const bool coordinated = layout_.attitude && layout_.airspeed;
  const Eigen::Index n = record.output.rows();
  for (int i = 0; i < 3; ++i) {
    const bool turns = i == 2 && coordinated;
    Eigen::MatrixX3d regressor = Eigen::MatrixX3d::Zero(n, 3);
    regressor.col(0) = record.reference.col(i) - record.output.col(i);
    regressor.col(1).setOnes();
    if (turns) {
      regressor.col(2) = kGravity * record.attitude.col(0).array().sin() *
                         record.attitude.col(1).array().cos() / record.airspeed.col(0).array();
    }
    Eigen::Matrix3d normal = regressor.transpose() * regressor;
    if (!turns) normal(2, 2) = 1.0;
    const Eigen::Vector3d found = normal.inverse() * (regressor.transpose() * record.input.col(i));
    out[i] = gain_[i] != 0.0 ? found[0] / gain_[i] - 1.0 : 0.0;
    out[3 + i] = found[1];
    if (turns) out[6] = gain_[i] != 0.0 ? found[2] / gain_[i] - 1.0 : 0.0;
  }
}

}  // namespace fatmc
