#include "core/ident/lpm_grid.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/ident/window_polynomial.h"

namespace fatmc {
namespace {

std::size_t index(int i) { return static_cast<std::size_t>(i); }

template <typename T>
std::span<const T> slice(const std::vector<T>& values, int k, int size) {
  return std::span<const T>(values).subspan(index(k) * index(size), index(size));
}

Status check(const PeriodicExperiment& e, const LpmOptions& o, int n_in) {
  const auto n = [](int value) { return std::to_string(value); };
  if (o.n_e < 1) return fail(Error{"", 0, "n-e", n(o.n_e) + " lines on each side, take at least 1"});
  if (o.order < 0 || o.order > 8) return fail(Error{"", 0, "order", n(o.order) + " is not in 0 ... 8"});
  if (n_in < 1) return fail("an estimate needs at least one input");
  if (e.period_samples < 3 || !(e.rate_hz > 0.0)) return fail("a period needs 3 samples and a positive rate");
  if (e.periods < 2) return fail("the fast LPM needs at least 2 whole periods, the record holds " + n(e.periods));
  for (std::size_t i = 0; i < e.lines.size(); ++i) {
    if (e.lines[i] < 1 || 2 * e.lines[i] >= e.period_samples || (i > 0 && e.lines[i] <= e.lines[i - 1])) {
      return fail(Error{"", 0, "excited_lines", "line " + n(e.lines[i]) +
                                                    " is out of order or outside 1 ... half the period (" +
                                                    n((e.period_samples - 1) / 2) + ")"});
    }
  }
  const int window = 2 * o.n_e + 1;
  if (static_cast<int>(e.lines.size()) < window) {
    return fail(Error{"", 0, "n-e", "the window of 2 n_E + 1 = " + n(window) + " lines is wider than the " +
                                        n(static_cast<int>(e.lines.size())) + " excited lines, take a smaller n_E"});
  }
  if (window - (o.order + 1) * n_in < 1) {
    return fail(Error{"", 0, "n-e", "q = 2 n_E + 1 - (R + 1) n_in = " + n(window - (o.order + 1) * n_in) +
                                        " leaves no degree of freedom, take n_E >= " +
                                        n(((o.order + 1) * n_in + 1) / 2)});
  }
  if (2 * o.n_transient - (o.order + 1) < 1) {
    return fail(Error{"", 0, "n-transient", n(o.n_transient) + " bins on each side leave no degree of freedom, take " +
                                                n((o.order + 3) / 2) + " or more"});
  }
  return {};
}

}  // namespace

Result<LpmGrid> LpmGrid::create(PeriodicExperiment experiment, LpmOptions options, int n_in) {
  if (Status status = check(experiment, options, n_in); !status) return fail(status.error());
  LpmGrid grid;
  grid.experiment_ = std::move(experiment);
  grid.options_ = options;
  grid.n_in_ = n_in;
  grid.place_windows();
  grid.transient_ = TransientWindows(grid.experiment_.lines, grid.experiment_.period_samples, grid.experiment_.periods,
                                     2 * options.n_transient, options.order);
  if (grid.transient_.line_count() == 0) {
    return fail(Error{"", 0, "n-transient", "there are fewer than " + std::to_string(2 * options.n_transient) +
                                                " non-excited DFT bins in the excited band, take a smaller number"});
  }
  grid.fit_bias_polynomials();
  return grid;
}

double LpmGrid::frequency_hz(int k) const {
  return experiment_.lines[index(k)] * experiment_.rate_hz / experiment_.period_samples;
}

std::span<const double> LpmGrid::offsets_hz(int k) const { return slice(offsets_hz_, k, window()); }
std::span<const double> LpmGrid::scaled_offsets(int k) const { return slice(scaled_offsets_, k, window()); }
std::span<const double> LpmGrid::constant_row(int k) const { return slice(constant_rows_, k, window()); }
std::span<const double> LpmGrid::own_constant_row(int k) const { return slice(own_constant_rows_, k, window()); }
std::span<const double> LpmGrid::linear_row(int k) const { return slice(linear_rows_, k, window()); }
std::span<const double> LpmGrid::quadratic_row(int k) const { return slice(quadratic_rows_, k, window()); }

int LpmGrid::bias_exponent() const { return fatmc::bias_exponent(options_.order); }

void LpmGrid::place_windows() {
  for (int k = 0; k < line_count(); ++k) {
    const int start = std::clamp(k - options_.n_e, 0, line_count() - window());
    first_.push_back(start);
    double largest = 0.0;
    for (int i = start; i < start + window(); ++i) {
      // Harmonics are whole numbers: their difference is exact, that of frequencies would not be.
      const int distance = experiment_.lines[index(i)] - experiment_.lines[index(k)];
      offsets_hz_.push_back(distance * experiment_.rate_hz / experiment_.period_samples);
      largest = std::max(largest, std::abs(offsets_hz_.back()));
    }
    scale_hz_.push_back(largest);
    for (const double offset : offsets_hz(k)) scaled_offsets_.push_back(offset / largest);
  }
}

void LpmGrid::fit_bias_polynomials() {
  const auto append = [](std::vector<double>& rows, const std::vector<double>& row) {
    rows.insert(rows.end(), row.begin(), row.end());
  };
  for (int k = 0; k < line_count(); ++k) {
    const WindowPolynomial fit = window_polynomial(scaled_offsets(k), scale_hz(k), options_.order);
    append(constant_rows_, fit.constant);
    append(own_constant_rows_, fit.own_constant);
    append(linear_rows_, fit.linear);
    append(quadratic_rows_, fit.quadratic);
    bias_moment_.push_back(fit.moment);
  }
}

}  // namespace fatmc
