#include "campaigns/formulas/lightly_damped.h"

#include <Eigen/QR>
#include <cmath>

#include "core/base/check.h"

namespace fatmc {
namespace {

double part_of(std::complex<double> g, FittedPart part) {
  return part == FittedPart::magnitude ? std::abs(g) : g.imag();
}

/// Powers of offset/largest offset, so that the columns are of one size.
Eigen::MatrixXd powers(std::span<const double> offsets, int degree, double scale) {
  Eigen::MatrixXd out(static_cast<Eigen::Index>(offsets.size()), degree + 1);
  for (Eigen::Index i = 0; i < out.rows(); ++i) {
    double power = 1.0;
    for (int g = 0; g <= degree; ++g, power *= offsets[static_cast<std::size_t>(i)] / scale)
      out(i, g) = power;
  }
  return out;
}

double largest(std::span<const double> offsets) {
  double out = 0.0;
  for (const double d : offsets) out = std::max(out, std::abs(d));
  FATMC_CHECK(out > 0.0, "a window has a width");
  return out;
}

Eigen::VectorXd coefficients(const LightlyDamped& system, double centre, std::span<const double> offsets,
                             int degree, FittedPart part) {
  FATMC_CHECK(static_cast<int>(offsets.size()) > degree, "more lines than coefficients");
  Eigen::VectorXd values(static_cast<Eigen::Index>(offsets.size()));
  for (std::size_t i = 0; i < offsets.size(); ++i)
    values(static_cast<Eigen::Index>(i)) = part_of(system.response(centre + offsets[i]), part);
  return powers(offsets, degree, largest(offsets)).householderQr().solve(values);
}

}  // namespace

LightlyDamped::LightlyDamped(double damping) : damping_(damping), peak_(1.0) {
  FATMC_CHECK(damping > 0.0 && damping < 1.0, "an oscillating mode");
  peak_ = std::abs(response(0.0));
}

std::complex<double> LightlyDamped::response(double x) const {
  const double w = std::sqrt(1.0 - damping_ * damping_) + x * damping_;  // w0 = 1
  return 1.0 / (peak_ * std::complex<double>(1.0 - w * w, 2.0 * damping_ * w));
}

std::vector<double> even_offsets(int count, double width) {
  FATMC_CHECK(count >= 2 && width > 0.0, "a window");
  std::vector<double> out;
  for (int i = 0; i < count; ++i) out.push_back(width * (2.0 * i / (count - 1) - 1.0));
  return out;
}

double polynomial_at_centre(const LightlyDamped& system, double centre, std::span<const double> offsets,
                            int degree, FittedPart part) {
  return coefficients(system, centre, offsets, degree, part)(0);
}

std::vector<double> polynomial_values(const LightlyDamped& system, double centre,
                                      std::span<const double> offsets, int degree, FittedPart part,
                                      std::span<const double> at) {
  const Eigen::VectorXd values =
      powers(at, degree, largest(offsets)) * coefficients(system, centre, offsets, degree, part);
  return {values.begin(), values.end()};
}

std::complex<double> polynomial_error(const LightlyDamped& system, double centre,
                                      std::span<const double> offsets, int degree) {
  Eigen::VectorXd real(static_cast<Eigen::Index>(offsets.size())), imag(real.size());
  for (std::size_t i = 0; i < offsets.size(); ++i) {
    const std::complex<double> g = system.response(centre + offsets[i]);
    real(static_cast<Eigen::Index>(i)) = g.real();
    imag(static_cast<Eigen::Index>(i)) = g.imag();
  }
  const auto qr = powers(offsets, degree, largest(offsets)).householderQr();
  return std::complex<double>(qr.solve(real)(0), qr.solve(imag)(0)) - system.response(centre);
}

}  // namespace fatmc
