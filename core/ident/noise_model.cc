#include "core/ident/noise_model.h"

#include <cmath>
#include <string>

#include "core/base/check.h"
#include "core/ident/mean_spectra.h"

namespace fatmc {

Result<NoiseModel> noise_model(const Eigen::Ref<const Eigen::MatrixXd>& samples, double rate_hz,
                               int segment_samples) {
  FATMC_CHECK(rate_hz > 0.0 && samples.cols() >= 1, "a sampled record");
  const auto available = static_cast<int>(samples.rows());
  if (segment_samples < 4 || 2 * segment_samples > available) {
    return fail(Error{"", 0, "segment",
                      "two segments of " + std::to_string(segment_samples) + " samples do not fit into the " +
                          std::to_string(available) + " of the record: take 4 to " +
                          std::to_string(available / 2)});
  }
  NoiseModel out;
  out.channels = static_cast<int>(samples.cols());
  out.segments = available / segment_samples;
  out.segment_samples = segment_samples;
  out.rate_hz = rate_hz;
  const int bins = (segment_samples - 1) / 2;
  std::vector<Eigen::MatrixXcd> spectra;
  for (int l = 0; l < out.segments; ++l) {
    spectra.push_back(record_spectrum(samples.middleRows(l * segment_samples, segment_samples), bins + 1));
  }
  out.covariance.resize(out.channels, out.channels, bins);
  Eigen::MatrixXcd v(out.channels, out.segments);
  for (int k = 0; k < bins; ++k) {
    out.frequency_hz.push_back((k + 1) * rate_hz / segment_samples);
    for (int l = 0; l < out.segments; ++l)
      v.col(l) = spectra[static_cast<std::size_t>(l)].row(k + 1).transpose();
    v.colwise() -= v.rowwise().mean().eval();
    out.covariance[k] = v * v.adjoint() / static_cast<double>(out.q());
  }
  return out;
}

int required_segments(double variation) {
  FATMC_CHECK(variation > 0.0, "a relative error");
  // The small share keeps 1/0.1^2, which is 99.99... or 100.00... in doubles, from adding a segment.
  return 1 + static_cast<int>(std::ceil(1.0 / (variation * variation) * (1.0 - 1e-12)));
}

}  // namespace fatmc
