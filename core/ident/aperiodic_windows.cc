#include "core/ident/aperiodic_windows.h"

#include <cmath>
#include <string>

#include "core/ident/line_regression.h"

namespace fatmc {

BinBand within_limits(const BinBand& band, const Measurement& m, int samples) {
  const auto bin = [&](double hz) {
    return std::clamp(hz * samples / m.experiment.rate_hz, -1.0, band.last + 1.0);
  };
  constexpr double kRounding = 1e-6;  // a limit that is a bin's frequency takes that bin in
  return {std::max(band.first, static_cast<int>(std::ceil(bin(m.low_hz) - kRounding))),
          std::min(band.last, static_cast<int>(std::floor(bin(m.high_hz) + kRounding)))};
}

Result<BinBand> bin_band(const Measurement& m, int width) {
  BinBand band;
  band.last = (static_cast<int>(m.inputs.rows()) - 1) / 2;
  const PeriodicExperiment& e = m.experiment;
  if (!e.lines.empty() && e.periods >= 1) {
    band.first = std::max(band.first, e.periods * e.lines.front());
    band.last = std::min(band.last, e.periods * e.lines.back());
  }
  band = within_limits(band, m, static_cast<int>(m.inputs.rows()));
  if (band.count() < width) {
    return fail(Error{"", 0, "n-e",
                      "the window of " + std::to_string(width) + " DFT bins is wider than the " +
                          std::to_string(std::max(0, band.count())) + " bins there are, take a smaller n_E"});
  }
  return band;
}

void drop_rounding(Eigen::Ref<Eigen::MatrixXcd> known) {
  constexpr double kRounding = 1e-8;
  for (Eigen::Index j = 0; j < known.cols(); ++j) {
    const double floor = kRounding * known.col(j).cwiseAbs().maxCoeff();
    known.col(j) = (known.col(j).array().abs() > floor).select(known.col(j), 0.0);
  }
}

void begin_estimate(const Measurement& m, const BinBand& band, int width, FrmEstimate& e) {
  e.n_out = m.n_out();
  e.n_in = m.n_in();
  e.indirect = m.indirect();
  for (int bin = band.first; bin <= band.last; ++bin) {
    e.lines.push_back(bin);
    e.frequency_hz.push_back(bin * m.experiment.rate_hz / static_cast<double>(m.inputs.rows()));
  }
  size_estimate(e);
  for (int k = 0; k < e.line_count(); ++k) {
    const int bin = e.lines[static_cast<std::size_t>(k)];
    e.border[static_cast<std::size_t>(k)] = band.window(bin, width) == bin - width / 2 ? 0 : 1;
  }
}

}  // namespace fatmc
