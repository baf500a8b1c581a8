#include "core/discrepancy/resonance.h"

#include <cmath>
#include <complex>

#include "core/flight/aircraft.h"

namespace fatmc {
namespace {

constexpr std::string_view kMode = "flexible_mode";
constexpr double kBroadDamping = 0.5;
constexpr double kStep = 0.02;  // of the logarithm of the frequency

std::size_t place(const EffectKind& kind, std::string_view parameter) {
  return static_cast<std::size_t>(kind.parameter(parameter) - kind.parameters.data());
}

/// H(2 pi i f)/k, its sign left out.
std::complex<double> transfer(double f, double mode_hz, double damping) {
  const std::complex<double> s(0.0, 2.0 * kPi * f);
  const double w = 2.0 * kPi * mode_hz;
  return w * w * s / (s * s + 2.0 * damping * w * s + w * w);
}

}  // namespace

std::optional<Effect> broad_resonance(const Effect& variant) {
  if (variant.id != kMode) return std::nullopt;
  const EffectKind& kind = variant.kind();
  Effect out = variant;
  for (std::size_t p = 0; p < kind.parameters.size(); ++p)
    out.values[p] = kind.parameters[p].moderate(0.5, false);
  const std::size_t slope = place(kind, "slope");
  out.values[slope] = kind.parameters[slope].moderate_high;
  out.values[place(kind, "damping")] = kBroadDamping;
  return out;
}

ResonanceGrid resonance_grid(const FeatureLayout& layout, const Effect& broad,
                             const Eigen::Ref<const Eigen::VectorXd>& difference) {
  const EffectKind& kind = broad.kind();
  const std::size_t frequency = place(kind, "frequency_hz"), damping = place(kind, "damping");
  const EffectParameter& range = kind.parameters[frequency];
  const EffectParameter& width = kind.parameters[damping];
  ResonanceGrid out;
  const int steps =
      static_cast<int>(std::ceil(std::log(range.moderate_high / range.moderate_low) / kStep)) + 1;
  for (int i = 0; i < steps; ++i) {
    for (const double z :
         {width.moderate_low, std::sqrt(width.moderate_low * width.moderate_high), width.moderate_high}) {
      out.effects.push_back(broad);
      out.effects.back().values[frequency] = range.moderate_low * std::exp(i * kStep);
      out.effects.back().values[damping] = z;
    }
  }
  out.differences.setZero(difference.size(), static_cast<Eigen::Index>(out.effects.size()));
  for (const FeatureBlock& block : layout.blocks) {
    if (block.kind != FeatureKind::line) continue;
    const auto n = static_cast<Eigen::Index>(block.channels.size());
    const std::complex<double> own = transfer(block.low_hz, broad.values[frequency], broad.values[damping]);
    for (std::size_t e = 0; e < out.effects.size(); ++e) {
      const std::complex<double> ratio =
          transfer(block.low_hz, out.effects[e].values[frequency], out.effects[e].values[damping]) / own;
      for (Eigen::Index c = 0; c < n; ++c) {
        const std::complex<double> y =
            ratio * std::complex<double>(difference[block.first + c], difference[block.first + n + c]);
        out.differences(block.first + c, static_cast<Eigen::Index>(e)) = y.real();
        out.differences(block.first + n + c, static_cast<Eigen::Index>(e)) = y.imag();
      }
    }
  }
  return out;
}

}  // namespace fatmc
