#include "core/robust/confident_stability.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/check.h"
#include "core/robust/loop_matrix.h"
#include "core/stats/confidence.h"

namespace fatmc {
namespace {

double reciprocal(double value) {
  return value > 0.0 ? 1.0 / value : std::numeric_limits<double>::infinity();
}

JudgementStatus check(const EstimatedLine& line, const Eigen::Ref<const Eigen::MatrixXcd>& nominal,
                 const Eigen::Ref<const Eigen::MatrixXcd>& controller) {
  const Eigen::Index n_out = line.response.rows(), n_in = line.response.cols();
  const auto same = [&](const auto& m) { return m.rows() == n_out && m.cols() == n_in; };
  if (n_out == 0 || n_in == 0 || !same(line.sigma) || !same(nominal) || controller.rows() != n_in ||
      controller.cols() != n_out || (line.bias.size() > 0 && !same(line.bias))) {
    return JudgementStatus::wrong_shape;
  }
  if (!line.response.allFinite() || !line.sigma.allFinite() || !line.bias.allFinite() || !nominal.allFinite() ||
      !controller.allFinite() || !std::isfinite(line.degrees_of_freedom)) {
    return JudgementStatus::not_finite;
  }
  if (!(line.degrees_of_freedom > 0.0) || line.sigma.minCoeff() < 0.0 ||
      (line.bias.size() > 0 && line.bias.minCoeff() < 0.0)) {
    return JudgementStatus::wrong_shape;
  }
  return JudgementStatus::ok;
}

}  // namespace

Eigen::MatrixXd systematic_error(const EstimatedLine& line, const StabilityOptions& options) {
  Eigen::MatrixXd out = options.intergrid * line.response.cwiseAbs();
  if (options.bias && line.bias.size() > 0) out += line.bias;
  return out;
}

double element_confidence(double kappa, double sigma, double systematic, double q) {
  FATMC_CHECK(kappa >= 0.0 && sigma >= 0.0 && systematic >= 0.0 && q > 0.0, "confidence of a disc");
  if (sigma + systematic == 0.0) return 1.0;
  const double radius = kappa * (systematic + sigma) - systematic;
  if (!(radius > 0.0)) return 0.0;
  return sigma > 0.0 ? confidence_of_radius(radius / sigma, q) : 1.0;
}

double line_confidence(double kappa, const Eigen::Ref<const Eigen::MatrixXd>& sigma,
                       const Eigen::Ref<const Eigen::MatrixXd>& systematic, double q, CombinationRule rule) {
  FATMC_CHECK(sigma.rows() == systematic.rows() && sigma.cols() == systematic.cols(), "one bias an element");
  double least = 1.0, outside = 0.0;
  for (Eigen::Index j = 0; j < sigma.cols(); ++j) {
    for (Eigen::Index i = 0; i < sigma.rows(); ++i) {
      const double p = element_confidence(kappa, sigma(i, j), systematic(i, j), q);
      least = std::min(least, p);
      outside += 1.0 - p;
    }
  }
  return rule == CombinationRule::min ? least : std::max(0.0, 1.0 - outside);
}

std::string judgement_text(JudgementStatus status) {
  switch (status) {
    case JudgementStatus::ok: return "ok";
    case JudgementStatus::no_estimate: return "the estimator gave nothing: excite the line, or leave it out";
    case JudgementStatus::not_finite: return "estimate, deviation or model is not finite: drop the line or estimate it anew";
    case JudgementStatus::wrong_shape: return "shapes do not fit, or deviation, bias or q is out of range";
    case JudgementStatus::singular_loop:
      return "I + K G is singular: the loop is on the border of stability at this frequency";
  }
  return "unknown";
}

LineStability failed_line(JudgementStatus status) {
  const double infinity = std::numeric_limits<double>::infinity();
  LineStability out;
  out.status = status;
  out.h_infinity_nominal = out.ssv_nominal = out.h_infinity = infinity;
  out.ssv.upper = infinity;
  out.ssv.status = SsvStatus::not_converged;
  return out;
}

LineStability judge_line(const EstimatedLine& line, const Eigen::Ref<const Eigen::MatrixXcd>& nominal,
                         const Eigen::Ref<const Eigen::MatrixXcd>& controller, const StabilityOptions& options,
                         StabilityScalings* scalings) {
  const JudgementStatus status = check(line, nominal, controller);
  if (status != JudgementStatus::ok) return failed_line(status);
  const LoopMatrix nominal_loop = loop_matrix(nominal, controller);
  const LoopMatrix loop = loop_matrix(line.response, controller);
  if (!nominal_loop.invertible || !loop.invertible) return failed_line(JudgementStatus::singular_loop);

  LineStability out;
  const Eigen::MatrixXd difference = (line.response - nominal).cwiseAbs();
  out.h_infinity_nominal = h_infinity_value(nominal_loop.x, difference);
  out.ssv_nominal =
      structured_singular_value(nominal_loop.x, difference, {}, scalings ? &scalings->nominal : nullptr).upper;

  const Eigen::MatrixXd systematic = systematic_error(line, options);
  const Eigen::MatrixXd radii = systematic + line.sigma;
  out.h_infinity = h_infinity_value(loop.x, radii);
  out.ssv = structured_singular_value(loop.x, radii, {}, scalings ? &scalings->robust : nullptr);
  out.kappa_h_infinity = reciprocal(out.h_infinity);
  out.kappa_ssv = reciprocal(out.ssv.upper);
  const double q = line.degrees_of_freedom;
  out.p_h_infinity = line_confidence(out.kappa_h_infinity, line.sigma, systematic, q, options.combine);
  out.p_ssv = line_confidence(out.kappa_ssv, line.sigma, systematic, q, options.combine);

  // κ_nom > 1 written as value < 1; an SNR that is not a number does not suffice.
  out.snr_sufficient = !line.input_snr_db || *line.input_snr_db >= options.minimum_snr_db;
  if (out.snr_sufficient && out.h_infinity_nominal < 1.0) out.p_total_h_infinity = out.p_h_infinity;
  if (out.snr_sufficient && out.ssv_nominal < 1.0) out.p_total_ssv = out.p_ssv;
  return out;
}

BandStability combine_lines(std::span<const LineStability> lines) {
  BandStability out;
  for (const LineStability& line : lines) {
    out.nominally_stable_h_infinity = out.nominally_stable_h_infinity && line.h_infinity_nominal < 1.0;
    out.nominally_stable_ssv = out.nominally_stable_ssv && line.ssv_nominal < 1.0;
    out.p_h_infinity *= line.p_h_infinity;
    out.p_ssv *= line.p_ssv;
    out.p_total_h_infinity *= line.p_total_h_infinity;
    out.p_total_ssv *= line.p_total_ssv;
    if (line.status != JudgementStatus::ok) ++out.failed_lines;
    if (!line.snr_sufficient) ++out.low_snr_lines;
  }
  return out;
}

}  // namespace fatmc
