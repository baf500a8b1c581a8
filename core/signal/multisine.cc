#include "core/signal/multisine.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>

#include "core/base/check.h"
#include "core/base/text.h"
#include "core/signal/dft.h"

namespace fatmc {
namespace {

/// `frequency` as a multiple of `base`, or -1 where it is none.
int harmonic(double frequency, double base) {
  const double ratio = frequency / base;
  if (!(ratio > 0.5) || ratio > 1e9 || std::abs(ratio - std::round(ratio)) > 1e-6 * std::max(1.0, ratio)) return -1;
  return static_cast<int>(std::lround(ratio));
}

}  // namespace

Result<std::vector<int>> lines_from_ranges(std::span<const FrequencyRange> ranges, double base_hz) {
  if (!(base_hz > 0.0)) return fail("the base frequency " + shortest(base_hz) + " Hz must be positive");
  std::set<int> lines;
  for (const FrequencyRange& range : ranges) {
    const int start = harmonic(range.start_hz, base_hz);
    const int stop = harmonic(range.stop_hz, base_hz);
    const int step = harmonic(range.step_hz, base_hz);
    if (start < 1 || step < 1 || stop < start || (stop - start) % step != 0) {
      return fail("the range " + shortest(range.start_hz) + " to " + shortest(range.stop_hz) + " Hz in steps of " +
                  shortest(range.step_hz) + " Hz must start, step and end on multiples of " + shortest(base_hz) +
                  " Hz, the stop must be reached by whole steps");
    }
    for (int line = start; line <= stop; line += step) lines.insert(line);
  }
  return std::vector<int>(lines.begin(), lines.end());
}

std::vector<int> zippered_lines(std::span<const int> lines, int input, int inputs) {
  FATMC_CHECK(0 <= input && input < inputs, "one of the inputs");
  std::vector<int> out;
  for (auto i = static_cast<std::size_t>(input); i < lines.size(); i += static_cast<std::size_t>(inputs)) {
    out.push_back(lines[i]);
  }
  return out;
}

std::span<const FrequencyRange> table_5_1_ranges() {
  static constexpr std::array<FrequencyRange, 3> kRanges = {
      FrequencyRange{0.285, 0.38, 0.005}, FrequencyRange{0.38, 0.58, 0.01}, FrequencyRange{0.58, 2.89, 0.07}};
  return kRanges;
}

Multisine::Multisine(int period_samples, std::vector<int> lines, std::vector<double> amplitudes,
                     std::vector<double> phases)
    : period_samples_(period_samples),
      lines_(std::move(lines)),
      amplitudes_(std::move(amplitudes)),
      phases_(std::move(phases)) {
  FATMC_CHECK(lines_.size() == amplitudes_.size() && lines_.size() == phases_.size(), "one entry a line");
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    FATMC_CHECK(lines_[i] > 0 && 2 * lines_[i] < period_samples_, "lines lie between zero and half the rate");
    FATMC_CHECK(i == 0 || lines_[i] > lines_[i - 1], "lines ascend");
  }
}

Multisine Multisine::random_phase(int period_samples, std::vector<int> lines, std::vector<double> amplitudes,
                                  RandomStream& stream) {
  std::vector<double> phases(lines.size());
  for (double& phase : phases) phase = 2.0 * std::numbers::pi * stream.uniform();
  return Multisine(period_samples, std::move(lines), std::move(amplitudes), std::move(phases));
}

Multisine Multisine::random_phase(int period_samples, std::vector<int> lines, double amplitude,
                                  RandomStream& stream) {
  std::vector<double> amplitudes(lines.size(), amplitude);
  return random_phase(period_samples, std::move(lines), std::move(amplitudes), stream);
}

std::vector<double> Multisine::period() const {
  std::vector<std::complex<double>> bins(lines_.empty() ? 1 : static_cast<std::size_t>(lines_.back()) + 1);
  const std::vector<std::complex<double>> values = spectrum(1);
  for (std::size_t i = 0; i < lines_.size(); ++i) bins[static_cast<std::size_t>(lines_[i])] = values[i];
  std::vector<double> x(static_cast<std::size_t>(period_samples_));
  inverse_real_dft(bins, x);
  return x;
}

std::vector<double> Multisine::samples(int periods) const {
  FATMC_CHECK(periods >= 1, "at least one period");
  const std::vector<double> one = period();
  std::vector<double> x;
  x.reserve(one.size() * static_cast<std::size_t>(periods));
  for (int p = 0; p < periods; ++p) x.insert(x.end(), one.begin(), one.end());
  return x;
}

std::vector<std::complex<double>> Multisine::spectrum(int periods) const {
  const double scale = 0.5 * std::sqrt(static_cast<double>(periods) * period_samples_);
  std::vector<std::complex<double>> values(lines_.size());
  for (std::size_t i = 0; i < lines_.size(); ++i) values[i] = std::polar(scale * amplitudes_[i], phases_[i]);
  return values;
}

double Multisine::rms() const {
  double power = 0.0;
  for (const double a : amplitudes_) power += 0.5 * a * a;
  return std::sqrt(power);
}

double rms(std::span<const double> x) {
  double power = 0.0;
  for (const double v : x) power += v * v;
  return x.empty() ? 0.0 : std::sqrt(power / static_cast<double>(x.size()));
}

double crest_factor(std::span<const double> x) {
  double peak = 0.0;
  for (const double v : x) peak = std::max(peak, std::abs(v));
  return peak > 0.0 ? peak / rms(x) : 0.0;
}

}  // namespace fatmc
