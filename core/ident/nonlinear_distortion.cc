#include "core/ident/nonlinear_distortion.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/check.h"
#include "core/stats/confidence.h"

namespace fatmc {
namespace {

double ratio(double total, double noise) {
  if (noise > 0.0) return total / noise;
  return total > 0.0 ? std::numeric_limits<double>::infinity() : 1.0;
}

}  // namespace

double NonlinearDistortion::median_output_ratio(int i) const {
  std::vector<double> values;
  for (int k = 0; k < output_ratio.count(); ++k) values.push_back(output_ratio[k](i, 0));
  FATMC_CHECK(!values.empty(), "a line");
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

NonlinearDistortion nonlinear_distortion(const FrmEstimate& e, double level) {
  FATMC_CHECK(e.q_noise > 0 && e.q > 0, "a noise estimate of its own");
  NonlinearDistortion out;
  out.level = level;
  out.limit = f_quantile(1.0 - level, 2.0 * e.q, 2.0 * e.q_noise);
  const int channels = e.indirect ? e.n_out + e.n_in : 0;
  out.output_ratio.resize(e.n_out, 1, e.line_count());
  out.channel_ratio.resize(channels, 1, e.line_count());
  out.above.assign(static_cast<std::size_t>(e.n_out), 0);
  for (int k = 0; k < e.line_count(); ++k) {
    const bool ok = e.status[static_cast<std::size_t>(k)] == LineStatus::ok;
    for (int i = 0; i < channels; ++i) {
      out.channel_ratio[k](i, 0) = ok ? ratio(e.C_Z[k](i, i).real(), e.C_Z_noise[k](i, i).real()) : 1.0;
    }
    for (int i = 0; i < e.n_out; ++i) {
      const double value = ok ? ratio(e.C_V[k](i, i).real(), e.C_V_noise[k](i, i).real()) : 1.0;
      out.output_ratio[k](i, 0) = value;
      if (value > out.limit) ++out.above[static_cast<std::size_t>(i)];
    }
  }
  return out;
}

double distortion_variance(const FrmEstimate& e, int k, int i) {
  const double noise = e.indirect ? e.C_Z_noise[k](i, i).real() : e.C_V_noise[k](i, i).real();
  return std::max(0.0, e.C_Z[k](i, i).real() - noise);
}

}  // namespace fatmc
