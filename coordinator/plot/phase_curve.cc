#include "coordinator/plot/phase_curve.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fatmc::plot {

std::vector<double> unwrapped(std::vector<double> deg) {
  for (std::size_t k = 1; k < deg.size(); ++k) deg[k] += 360.0 * std::round((deg[k - 1] - deg[k]) / 360.0);
  return deg;
}

Band turns(const std::vector<double>& x, const std::vector<double>& low, const std::vector<double>& high) {
  Band out;
  if (x.empty()) return out;
  const double first = std::ceil((*std::min_element(low.begin(), low.end()) - 180.0) / 360.0);
  const double last = std::floor((*std::max_element(high.begin(), high.end()) + 180.0) / 360.0);
  const auto add = [&](double at, double a, double b) {
    out.x.push_back(at);
    out.low.push_back(a);
    out.high.push_back(b);
  };
  for (double turn = 360.0 * first; turn <= 360.0 * last; turn += 360.0) {
    const auto seen = [&](std::size_t a, std::size_t b) {  // something between these points lies in the panel
      return std::min(low[a], low[b]) - turn <= 180.0 && std::max(high[a], high[b]) - turn >= -180.0;
    };
    for (std::size_t k = 0; k < x.size(); ++k) {
      if ((k > 0 && seen(k - 1, k)) || seen(k, k) || (k + 1 < x.size() && seen(k, k + 1))) {
        add(x[k], low[k] - turn, high[k] - turn);
      } else if (!out.x.empty() && std::isfinite(out.low.back())) {
        add(x[k], std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN());
      }
    }
    add(x.back(), std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN());
  }
  return out;
}

}  // namespace fatmc::plot
