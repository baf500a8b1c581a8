#include "core/robust/nominal_model.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

namespace fatmc {

std::optional<StabilisedModel> stabilise(const SampledModel& model, double radius) {
  StabilisedModel out{model, 0, 0.0};
  const Eigen::Index n = model.a.rows();
  if (model.a.cols() != n || !model.a.allFinite()) return std::nullopt;
  if (n == 0) return out;
  const Eigen::RealSchur<Eigen::MatrixXd> schur(model.a);
  if (schur.info() != Eigen::Success) return std::nullopt;
  Eigen::MatrixXd t = schur.matrixT();
  for (Eigen::Index k = 0; k < n;) {
    // A block of two holds a complex pair: its determinant is |z|².
    const Eigen::Index size = k + 1 < n && t(k + 1, k) != 0.0 ? 2 : 1;
    const double modulus =
        size == 1 ? std::abs(t(k, k)) : std::sqrt(std::abs(t(k, k) * t(k + 1, k + 1) - t(k, k + 1) * t(k + 1, k)));
    out.largest_modulus = std::max(out.largest_modulus, modulus);
    if (modulus > radius) {
      t.block(k, k, size, size) *= radius / modulus;
      out.moved_poles += static_cast<int>(size);
    }
    k += size;
  }
  if (out.moved_poles > 0) out.model.a = schur.matrixU() * t * schur.matrixU().transpose();
  return out;
}

Eigen::MatrixXcd sampled_response(const SampledModel& model, double frequency_hz, double rate_hz) {
  Eigen::MatrixXcd pencil = -model.a.cast<std::complex<double>>();
  pencil.diagonal().array() += std::polar(1.0, 2.0 * std::numbers::pi * frequency_hz / rate_hz);
  Eigen::MatrixXcd out = model.d.cast<std::complex<double>>();
  if (pencil.rows() > 0) {
    out += model.c.cast<std::complex<double>>() * pencil.partialPivLu().solve(model.b.cast<std::complex<double>>());
  }
  return out;
}

std::optional<double> closed_loop_radius(const SampledModel& model, const Eigen::Ref<const Eigen::MatrixXd>& controller) {
  const Eigen::Index n_in = model.b.cols();
  const Eigen::FullPivLU<Eigen::MatrixXd> direct(Eigen::MatrixXd::Identity(n_in, n_in) + controller * model.d);
  if (!direct.isInvertible()) return std::nullopt;
  if (model.a.rows() == 0) return 0.0;
  const Eigen::MatrixXd feedback = direct.solve(Eigen::MatrixXd(controller * model.c));
  const Eigen::EigenSolver<Eigen::MatrixXd> poles(model.a - model.b * feedback, false);
  if (poles.info() != Eigen::Success) return std::nullopt;
  return poles.eigenvalues().cwiseAbs().maxCoeff();
}

}  // namespace fatmc
