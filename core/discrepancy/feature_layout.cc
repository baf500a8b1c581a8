#include "core/discrepancy/feature_layout.h"

#include <algorithm>

namespace fatmc {
namespace {

// Edges of the bands of noise, Hz: a decade in two or three. What lies above half the rate is cut off.
constexpr double kNoiseEdges[] = {0.01, 0.05, 0.15, 0.3, 0.6, 1.2, 2.5, 5.0, 10.0, 25.0};
constexpr int kFewestBins = 20;  // the log of a mean of 20 exponential variables is normal to a few per cent

std::vector<int> range(int first, int last) {
  std::vector<int> out;
  for (int i = first; i < last; ++i) out.push_back(i);
  return out;
}

struct Builder {
  FeatureLayout& layout;
  void add(FeatureKind kind, std::vector<int> channels, int line, double low, double high) {
    FeatureBlock block{kind, layout.size, std::move(channels), line, low, high};
    layout.size += block.size();
    layout.blocks.push_back(std::move(block));
  }
};

}  // namespace

std::string_view name(FeatureKind kind) {
  switch (kind) {
    case FeatureKind::line:
      return "line";
    case FeatureKind::dc:
      return "dc";
    case FeatureKind::noise:
      return "noise";
    case FeatureKind::peak:
      return "peak";
    case FeatureKind::distortion:
      return "distortion";
    case FeatureKind::lattice:
      return "lattice";
    case FeatureKind::controller:
      return "controller";
    case FeatureKind::moment:
      return "moment";
  }
  return "?";
}

Result<FeatureLayout> FeatureLayout::create(PeriodicExperiment experiment, bool attitude, bool airspeed,
                                            bool controller) {
  FeatureLayout out;
  out.channels = {"p", "q", "r"};
  if (attitude) out.channels.insert(out.channels.end(), {"phi", "theta"});
  const int responses = static_cast<int>(out.channels.size());
  if (airspeed) out.channels.emplace_back("V");
  const int all = static_cast<int>(out.channels.size());
  out.attitude = attitude;
  out.airspeed = airspeed;
  out.controller = controller;

  const double rate = experiment.rate_hz;
  const int periods = experiment.periods;
  const double bin_hz = rate / (static_cast<double>(periods) * experiment.period_samples);
  if (periods < 2) return fail("holds one period: two are needed to tell response from noise");
  Builder build{out};
  for (std::size_t k = 0; k < experiment.lines.size(); ++k) {
    const double f = experiment.lines[k] * periods * bin_hz;
    build.add(FeatureKind::line, range(0, responses), static_cast<int>(k), f, f);
  }
  build.add(FeatureKind::dc, range(0, attitude ? all + 1 : all), -1, 0.0, 0.0);

  const double half = 0.5 * rate;
  const double first = experiment.lines.front() * periods * bin_hz;
  const double last = experiment.lines.back() * periods * bin_hz;
  double low = std::max(kNoiseEdges[0], 2.0 * bin_hz);
  for (const double edge : kNoiseEdges) {
    const double high = std::min(edge, half);
    const double noise_bins = (high - low) / bin_hz * (periods - 1) / periods;
    if (noise_bins < kFewestBins) continue;  // joins the next band
    build.add(FeatureKind::noise, range(0, all), -1, low, high);
    build.add(FeatureKind::peak, range(0, 3), -1, low, high);
    // Harmonics carry distortion up to a few times the last line; there are fewer of them.
    if (high > first && low < 3.0 * last && (high - low) / (bin_hz * periods) > 2.0 * kFewestBins) {
      build.add(FeatureKind::distortion, range(0, 3), -1, low, high);
    }
    low = high;
  }
  build.add(FeatureKind::lattice, range(0, 3), -1, 0.0, 0.0);
  if (controller) build.add(FeatureKind::controller, range(0, attitude && airspeed ? 7 : 6), -1, 0.0, 0.0);
  out.experiment = std::move(experiment);
  return out;
}

FeatureLayout FeatureLayout::with_moments(const std::vector<Effect>& moments) const {
  FeatureLayout out = *this;
  if (moments.empty()) return out;
  std::vector<int> axes;
  for (const Effect& moment : moments) {
    const auto& names = moment.kind().choices.front().values;
    const auto at = std::find(names.begin(), names.end(), moment.choices.front().second);
    axes.push_back(static_cast<int>(at - names.begin()));
  }
  Builder{out}.add(FeatureKind::moment, std::move(axes), -1, 0.0, 0.0);
  return out;
}

}  // namespace fatmc
