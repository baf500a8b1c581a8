#include "campaigns/variance/row_arrays.h"

namespace fatmc::variance {

std::vector<int> shown_lines(const std::vector<double>& frequency_hz) {
  constexpr double kEnds = 0.15 + 1e-6;
  constexpr int kStep = 10;
  std::vector<int> out;
  int since = 0;
  for (std::size_t k = 0; k < frequency_hz.size(); ++k) {
    const bool end =
        frequency_hz[k] <= frequency_hz.front() + kEnds || frequency_hz[k] >= frequency_hz.back() - kEnds;
    since = end ? 0 : since + 1;
    if (end || since % kStep == 0) out.push_back(static_cast<int>(k));
  }
  return out;
}

}  // namespace fatmc::variance
