#include "tools/actfhs_problem.h"

#include <array>
#include <cmath>
#include <unsupported/Eigen/MatrixFunctions>

#include "core/base/check.h"
#include "core/base/text.h"
#include "core/handling/control_loop.h"
#include "core/handling/modes.h"
#include "core/subspace/eigenvalues.h"

namespace fatmc::fit {
namespace {

constexpr double kGravity = 9.81, kSpeed = 30.87;  // 60 kt
constexpr double kRate = 25.0;
constexpr int kDigits = 5, kMatrixDigits = 10;

enum State : Eigen::Index { u, v, w, p, q, r, phi, theta, b1, a1, x, xd, n0, ns, nc, kStates };
enum Input : Eigen::Index { dx, dy, dp, d0, kInputs };

struct Row {
  const char* name;
  double value, spread;
};

/// In the order of the values. What stands after kFitted rows below is fixed.
constexpr std::array kPriors = {
    Row{"X_u", -0.03, 0.01},     Row{"X_w", 0.03, 0.02},  Row{"Z_u", -0.05, 0.03},
    Row{"Z_w", -0.8, 0.15},      Row{"M_u", 0.014, 0.01}, Row{"M_w", 0.08, 0.03},
    Row{"M_q", -0.2, 0.2},       Row{"M_a", 10.5, 3.0},   Row{"K_a", 0.00028, 0.0001},
    Row{"Y_v", -0.08, 0.02},     Row{"L_v", -0.2, 0.03},  Row{"L_p", 0.0, 0.3},
    Row{"L_r", 0.05, 0.1},       Row{"N_v", 0.13, 0.02},  Row{"N_p", -0.15, 0.1},
    Row{"N_r", -0.5, 0.1},       Row{"L_b", 160.0, 20.0}, Row{"tau", 0.035, 0.005},
    Row{"K_b", 0.00075, 0.0002}, Row{"omega", 12.1, 0.3}, Row{"damping", 0.025, 0.01},
    Row{"f_b", -60.0, 20.0},     Row{"f_p", -40.0, 10.0}, Row{"L_x", 37.0, 10.0},
    Row{"L_d", 2.5, 2.0},        Row{"b_d", -0.6, 0.2},   Row{"ci", 19.0, 3.0},
    Row{"cs", 19.0, 3.0},        Row{"t_i", 0.06, 0.01}};

// Fixed: what no printed figure depends on much.
constexpr double kXa = -kGravity, kYb = kGravity, kZn = -10.0, kZ0 = -0.08, kM0 = 0.003, kN0 = -0.004,
                 kNp = 0.02, kLp = 0.004, kYp = -0.02, kT0 = 0.12, kC0 = 0.01, kCw = 0.02, kKbx = 0.06,
                 kKay = -0.06, kCross = 1.5;

const std::array<const char*, kStates> kStateNames = {"u",  "v",  "w", "p",  "q",  "r",  "phi", "theta",
                                                      "b1", "a1", "x", "x'", "n0", "ns", "nc"};

/// Values by name.
class Values {
 public:
  explicit Values(const Eigen::VectorXd& values) : values_(values) {
    FATMC_CHECK(values.size() == static_cast<Eigen::Index>(kPriors.size()), "one value a prior");
  }
  double operator()(std::string_view name) const {
    for (std::size_t i = 0; i < kPriors.size(); ++i) {
      if (kPriors[i].name == name) return values_[static_cast<Eigen::Index>(i)];
    }
    FATMC_CHECK(false, "no such value");
  }

 private:
  const Eigen::VectorXd& values_;
};

void fuselage(const Values& d, ContinuousModel& m) {
  m.a(u, u) = d("X_u"), m.a(u, w) = d("X_w"), m.a(u, theta) = -kGravity, m.a(u, a1) = kXa;
  m.a(v, v) = d("Y_v"), m.a(v, r) = -kSpeed, m.a(v, phi) = kGravity, m.a(v, b1) = kYb, m.b(v, dp) = kYp;
  m.a(w, u) = d("Z_u"), m.a(w, w) = d("Z_w"), m.a(w, q) = kSpeed, m.a(w, n0) = kZn, m.b(w, d0) = kZ0;
  m.a(p, v) = d("L_v"), m.a(p, p) = d("L_p"), m.a(p, r) = d("L_r"), m.a(p, b1) = d("L_b"),
         m.a(p, x) = d("L_x"), m.a(p, xd) = d("L_d"), m.b(p, dp) = kLp;
  m.a(q, u) = d("M_u"), m.a(q, w) = d("M_w"), m.a(q, q) = d("M_q"), m.a(q, a1) = d("M_a"), m.b(q, d0) = kM0;
  m.a(r, v) = d("N_v"), m.a(r, p) = d("N_p"), m.a(r, r) = d("N_r"), m.b(r, dp) = kNp, m.b(r, d0) = kN0;
  m.a(phi, p) = 1.0, m.a(theta, q) = 1.0;
}

void rotor(const Values& d, ContinuousModel& m) {
  const double tau = d("tau"), w_l = d("omega");
  m.a(b1, p) = -1.0, m.a(b1, b1) = -1.0 / tau, m.a(b1, a1) = kCross, m.a(b1, ns) = d("ci"),
          m.a(b1, xd) = d("b_d");
  m.a(a1, q) = -1.0, m.a(a1, a1) = -1.0 / tau, m.a(a1, b1) = -kCross, m.a(a1, nc) = d("ci");
  m.b(b1, dy) = d("K_b") / tau, m.b(b1, dx) = kKbx * d("K_a") / tau;
  m.b(a1, dx) = d("K_a") / tau, m.b(a1, dy) = kKay * d("K_b") / tau;
  m.a(x, xd) = 1.0, m.a(xd, x) = -w_l * w_l, m.a(xd, xd) = -2.0 * d("damping") * w_l;
  m.a(xd, b1) = d("f_b"), m.a(xd, p) = d("f_p");
  m.a(n0, n0) = -1.0 / kT0, m.a(n0, w) = kCw / kT0, m.b(n0, d0) = kC0 / kT0;
  m.a(ns, ns) = -1.0 / d("t_i"), m.a(ns, b1) = d("cs");
  m.a(nc, nc) = -1.0 / d("t_i"), m.a(nc, a1) = d("cs");
}

ContinuousModel vehicle(const ContinuousModel& bare, PublishedMode::Vehicle kind) {
  if (kind == PublishedMode::Vehicle::bare) return bare;
  return kind == PublishedMode::Vehicle::stabilized ? stabilized_vehicle(bare) : optimized_vehicle(bare);
}

/// Of the eigenvalues of an axis with that sign of the imaginary part, the nearest. The axis counts: with the
/// SCAS the Dutch roll lies near the phugoid, and would be fitted in its place.
std::complex<double> nearest(const ContinuousModel& model, std::complex<double> wanted,
                             PublishedMode::Axis axis) {
  std::complex<double> best(1e3, 1e3);
  const auto pairs = eigenpairs_of(model.a);
  if (!pairs) return best;
  for (Eigen::Index i = 0; i < pairs->values.size(); ++i) {
    const std::complex<double> s = pairs->values(i);
    const Eigen::ArrayXd shape = pairs->vectors.col(i).cwiseAbs().array();
    const bool pitch = shape(q) + shape(theta) > shape(p) + shape(r) + shape(phi);
    if (s.imag() < 0.0 || pitch != (axis == PublishedMode::Axis::pitch)) continue;
    if (std::abs(s - wanted) < std::abs(best - wanted)) best = s;
  }
  return best;
}

const std::complex<double> kBareLeadLag{-0.36, 12.0};

std::string matrix_lines(const char* name, const Eigen::MatrixXd& matrix) {
  std::string out = std::string(name) + " = [\n";
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    std::vector<std::string> row;
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) {
      const double value = std::abs(matrix(i, j)) < 1e-14 ? 0.0 : matrix(i, j);
      const std::string text = significant(value, kMatrixDigits);
      row.push_back(text.find_first_of(".en") == std::string::npos ? text + ".0" : text);
    }
    out += "  [" + join(row) + "],\n";
  }
  return out + "]\n";
}

}  // namespace

const std::vector<PublishedMode>& actfhs_published_modes() {
  using enum PublishedMode::Vehicle;
  using enum PublishedMode::Axis;
  static const std::vector<PublishedMode> modes = {{"phugoid", bare, pitch, 19.2, -0.16},
                                                   {"phugoid", stabilized, pitch, 4.9, 0.4},
                                                   {"roll/flap", stabilized, roll, 0.45, 0.32},
                                                   {"lead-lag", stabilized, roll, 0.55, 0.03},
                                                   {"roll/flap", optimized, roll, 0.43, 0.58}};
  return modes;
}

ContinuousModel actfhs_model(const Eigen::VectorXd& values) {
  const Values d(values);
  ContinuousModel m{Eigen::MatrixXd::Zero(kStates, kStates), Eigen::MatrixXd::Zero(kStates, kInputs),
                    Eigen::MatrixXd::Zero(8, kStates), Eigen::MatrixXd::Zero(8, kInputs)};
  m.c.leftCols(8).setIdentity();
  fuselage(d, m);
  rotor(d, m);
  return m;
}

ValueProblem actfhs_problem() {
  ValueProblem out;
  for (const Row& row : kPriors) out.priors.push_back({row.name, row.value, row.spread});
  for (const PublishedMode& mode : actfhs_published_modes()) {
    const std::complex<double> s = mode_of(mode.period_s, mode.damping).s;
    const double scale = 0.01 * std::abs(s);
    out.targets.push_back({mode.name + " re", s.real(), scale, true});
    out.targets.push_back({mode.name + " im", s.imag(), scale, true});
  }
  out.targets.push_back({"bare lead-lag re", kBareLeadLag.real(), 0.2});
  out.targets.push_back({"bare lead-lag im", kBareLeadLag.imag(), 0.2});
  out.model = [](const Eigen::VectorXd& values) {
    const ContinuousModel bare = actfhs_model(values);
    std::vector<double> reached;
    for (const PublishedMode& mode : actfhs_published_modes()) {
      const std::complex<double> s =
          nearest(vehicle(bare, mode.vehicle), mode_of(mode.period_s, mode.damping).s, mode.axis);
      reached.push_back(s.real());
      reached.push_back(s.imag());
    }
    const std::complex<double> lead_lag = nearest(bare, kBareLeadLag, PublishedMode::Axis::roll);
    reached.push_back(lead_lag.real());
    reached.push_back(lead_lag.imag());
    return Eigen::VectorXd(
        Eigen::Map<const Eigen::VectorXd>(reached.data(), static_cast<Eigen::Index>(reached.size())));
  };
  return out;
}

std::string actfhs_toml(const ValueFit& fit) {
  Eigen::VectorXd values = fit.values;
  std::string comment;
  for (std::size_t i = 0; i < kPriors.size(); ++i) {
    double& value = values[static_cast<Eigen::Index>(i)];
    const std::string text = significant(value, kDigits);
    value = std::stod(text);
    comment += (i % 5 == 0 ? "\n#   " : ", ") + std::string(kPriors[i].name) + " = " + text;
  }
  const ContinuousModel m = actfhs_model(values);
  const Eigen::Index n = m.a.rows(), size = n + m.b.cols();
  Eigen::MatrixXd step = Eigen::MatrixXd::Zero(size, size);
  step.topLeftCorner(kStates, kStates) = m.a / kRate;
  step.topRightCorner(kStates, kInputs) = m.b / kRate;
  const Eigen::MatrixXd held = step.exp();
  std::vector<std::string> states(kStateNames.begin(), kStateNames.end());
  return "# A linear helicopter at 60 kt with the modes that Wartmann & Greiser print of the ACT/FHS. "
         "Written by\n"
         "# tools/fit_actfhs; do not edit, run it again:\n"
         "#     build/release/bin/fit_actfhs > campaigns/models/actfhs_60kt.toml\n"
         "# Equations, and what is fitted to what: tools/actfhs_problem.h. x[n+1] = A x[n] + B u[n], y[n] = "
         "C x[n], the\n"
         "# continuous model below sampled with held controls. SI and rad, controls in per cent.\n"
         "# States: " +
         join(states) + "." + "\n# Fitted:" + comment +
         "\nkind = \"state_space\"\nname = \"ACT/FHS-like, 60 kt\"\nrate_hz = 25.0\n"
         "inputs = [\"delta_x\", \"delta_y\", \"delta_p\", \"delta_0\"]\n"
         "outputs = [\"u\", \"v\", \"w\", \"p\", \"q\", \"r\", \"phi\", \"theta\"]\n" +
         matrix_lines("A", held.topLeftCorner(kStates, kStates)) +
         matrix_lines("B", held.topRightCorner(kStates, kInputs)) + matrix_lines("C", m.c);
}

}  // namespace fatmc::fit
