#include "core/handling/modes.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/subspace/eigenvalues.h"

namespace fatmc {
namespace {

void sort_by_speed(std::vector<Mode>& modes) {
  std::stable_sort(modes.begin(), modes.end(),
                   [](const Mode& one, const Mode& other) { return std::abs(one.s) < std::abs(other.s); });
}

/// Poles of one element of the transfer matrix with their residues: sum r_i / (s - s_i).
struct Residues {
  Eigen::VectorXcd poles, residues;
};

Result<Residues> residues_of(const ContinuousModel& model, Eigen::Index output, Eigen::Index input) {
  const auto pairs = eigenpairs_of(model.a);
  if (!pairs) return fail("A is not finite");
  const Eigen::PartialPivLU<Eigen::MatrixXcd> lu(pairs->vectors);
  if (!(lu.rcond() > 1e-13)) return fail("A has no basis of eigenvectors");
  const Eigen::VectorXcd excited = lu.solve(model.b.col(input).cast<std::complex<double>>());
  const Eigen::RowVectorXcd seen = model.c.row(output) * pairs->vectors;
  return Residues{pairs->values, seen.transpose().cwiseProduct(excited)};
}

}  // namespace

double Mode::period_s() const { return 2.0 * std::numbers::pi / s.imag(); }

double Mode::damping() const { return -s.real() / std::abs(s); }

Mode mode_of(double period_s, double damping) {
  const double w = 2.0 * std::numbers::pi / period_s;
  return {{-damping / std::sqrt(1.0 - damping * damping) * w, w}};
}

Result<std::vector<Mode>> modes_of(const Eigen::Ref<const Eigen::MatrixXd>& a) {
  const auto values = eigenvalues_of(a);
  if (!values) return fail("A is not finite");
  std::vector<Mode> out;
  for (const std::complex<double>& s : *values) {
    if (s.imag() >= 0.0) out.push_back({s});
  }
  sort_by_speed(out);
  return out;
}

std::optional<Mode> nearest_mode(std::span<const Mode> modes, const Mode& wanted, double within) {
  std::optional<Mode> best;
  double least = within;
  for (const Mode& mode : modes) {
    const double distance = std::abs(mode.s - wanted.s) / std::abs(wanted.s);
    if (mode.oscillatory() && distance <= least) {
      least = distance;
      best = mode;
    }
  }
  return best;
}

Result<std::vector<ModeShare>> mode_shares(const ContinuousModel& model, Eigen::Index output,
                                           Eigen::Index input) {
  const auto found = residues_of(model, output, input);
  if (!found) return fail(found.error());
  std::vector<ModeShare> out;
  double largest = 0.0;
  for (Eigen::Index i = 0; i < found->poles.size(); ++i) {
    const std::complex<double> s = found->poles(i);
    if (s.imag() < 0.0) continue;
    const double decay = std::max(std::abs(s.real()), std::numeric_limits<double>::min());
    out.push_back({{s}, std::abs(found->residues(i)) / decay, 0.0});
    if (out.back().mode.oscillatory()) largest = std::max(largest, out.back().peak);
  }
  for (ModeShare& mode : out) {
    mode.share = largest > 0.0 ? mode.peak / largest : (mode.peak > 0.0 ? 1.0 : 0.0);
  }
  std::stable_sort(out.begin(), out.end(), [](const ModeShare& one, const ModeShare& other) {
    return std::abs(one.mode.s) < std::abs(other.mode.s);
  });
  return out;
}

Result<std::vector<double>> impulse_response(const ContinuousModel& model, Eigen::Index output,
                                             Eigen::Index input, std::span<const double> times_s) {
  const auto found = residues_of(model, output, input);
  if (!found) return fail(found.error());
  std::vector<double> out;
  for (const double t : times_s)
    out.push_back((found->residues.array() * (found->poles.array() * t).exp()).sum().real());
  return out;
}

}  // namespace fatmc
