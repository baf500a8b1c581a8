#include "core/ident/bias_reading.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <map>
#include <span>
#include <vector>

#include "core/base/check.h"
#include "core/ident/window_polynomial.h"

namespace fatmc {
namespace {

// What a line's window weighs with, in Hz or in line numbers.
struct Window {
  std::span<const double> constant, quadratic;
  double moment = 0.0;      // sum s_i d_i^E
  double half_width = 0.0;  // W / 2
};

// By line numbers the polynomial depends on the place of the line in its window alone.
class LineNumberWindows {
 public:
  explicit LineNumberWindows(const LpmGrid& grid) : grid_(grid) {}

  const WindowPolynomial& at(int place) {
    const auto known = fits_.find(place);
    if (known != fits_.end()) return known->second;
    const double scale = std::max(place, grid_.window() - 1 - place);
    std::vector<double> scaled;
    for (int i = 0; i < grid_.window(); ++i) scaled.push_back((i - place) / scale);
    return fits_.emplace(place, window_polynomial(scaled, scale, grid_.options().order)).first->second;
  }

 private:
  const LpmGrid& grid_;
  std::map<int, WindowPolynomial> fits_;
};

double curvature_ratio(const Window& window, const FrmEstimate& estimate, int first, int element,
                       BiasReading::Fit fit) {
  std::complex<double> g0, g2;
  for (std::size_t w = 0; w < window.constant.size(); ++w) {
    std::complex<double> g = estimate.G.data(first + static_cast<int>(w))[element];
    if (fit == BiasReading::Fit::magnitude) g = std::abs(g);
    g0 += window.constant[w] * g;
    g2 += window.quadratic[w] * g;
  }
  return std::abs(g0) > 0.0 ? std::abs(g2) / std::abs(g0) : 0.0;
}

}  // namespace

MatrixStack<double> interpolation_bias(const LpmGrid& grid, const FrmEstimate& estimate,
                                       const BiasReading& reading) {
  FATMC_CHECK(grid.line_count() == estimate.line_count(), "the grid behind the estimate");
  const int elements = estimate.n_out * estimate.n_in;
  const int exponent = grid.bias_exponent();
  MatrixStack<double> bias(estimate.n_out, estimate.n_in, estimate.line_count());
  LineNumberWindows numbered(grid);
  for (int k = 0; k < estimate.line_count(); ++k) {
    Window window;
    if (reading.distance == BiasReading::Distance::line_number) {
      const WindowPolynomial& fit = numbered.at(k - grid.first(k));
      window = {fit.constant, fit.quadratic, fit.moment, 0.5 * grid.window()};
    } else {
      const auto offsets = grid.offsets_hz(k);
      const double width = (offsets.back() - offsets.front()) * grid.window() / (grid.window() - 1);
      window = {grid.constant_row(k), grid.quadratic_row(k), grid.bias_moment(k), 0.5 * width};
    }
    const double sum = reading.constant == BiasConstant::exact_offsets
                           ? window.moment
                           : named_bias_constant(reading.constant, grid.options().order) *
                                 std::pow(window.half_width, exponent);
    for (int e = 0; e < elements; ++e) {
      // (2 / B_3dB)^2 = |g2 / g0| / kThreeDbDrop
      const double ratio = curvature_ratio(window, estimate, grid.first(k), e, reading.fit) / kThreeDbDrop;
      bias.data(k)[e] = sum * std::pow(ratio, exponent / 2) * std::abs(estimate.G.data(k)[e]);
    }
  }
  return bias;
}

}  // namespace fatmc
