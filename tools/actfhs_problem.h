// A linear helicopter at 60 kt whose modes are those that H prints of the ACT/FHS, since its data are not public.
//
// States: u v w p q r phi theta | lateral and longitudinal tilt of the rotor disc b1, a1 | regressive lead-lag
// x, x' | inflow n0 (mean), ns, nc (lateral and longitudinal). Explicit flapping of a hingeless rotor (Seher-Weiss
// & von Gruenhagen 2014): the disc follows the controls with a lag and pulls the fuselage, moments about the hub
// induce inflow that works against flapping, the lead-lag mode is driven by roll and disc and acts back on roll.
//
//   u' = X_u u + X_w w - g theta + X_a a1            v' = Y_v v - U r + g phi + Y_b b1 + Y_p d_p
//   w' = Z_u u + Z_w w + U q + Z_n n0 + Z_0 d_0
//   p' = L_v v + L_p p + L_r r + L_b b1 + L_x x + L_d x' + L_p d_p
//   q' = M_u u + M_w w + M_q q + M_a a1 + M_0 d_0    r' = N_v v + N_p p + N_r r + N_p d_p + N_0 d_0
//   b1' = -p - b1/tau + k a1 + ci ns + b_d x' + (K_b d_y + K_bx K_a d_x)/tau
//   a1' = -q - a1/tau - k b1 + ci nc + (K_a d_x + K_ay K_b d_y)/tau
//   x'' = -w^2 x - 2 D w x' + f_b b1 + f_p p
//   n0' = (-n0 + c_w w + c_0 d_0)/t_0,  ns' = -ns/t_i + cs b1,  nc' = -nc/t_i + cs a1
//
// SI and rad, controls d_x, d_y, d_p, d_0 in per cent. Constraints: the five modes of H 5.1 (bare phugoid;
// phugoid, roll/flap, lead-lag with H 14; roll/flap with H 15 too). The bare lead-lag mode near 12 rad/s
// (H 4.3) is a target. Priors are the order of magnitude of such helicopters' derivatives, those of the yaw axis for
// a Dutch roll of 3 s that is damped and a stable spiral, chosen so that the modes come near; they are no figures of
// the ACT/FHS.
#pragma once

#include <string>
#include <vector>

#include "core/subspace/discrete_model.h"
#include "tools/fit_problem.h"

namespace fatmc::fit {

ValueProblem actfhs_problem();

/// The model of values in the order of the priors.
ContinuousModel actfhs_model(const Eigen::VectorXd& values);

/// campaigns/models/actfhs_60kt.toml: sampled at 25 Hz with held controls. Values are rounded to the digits
/// that the file shows before the model is made of them.
std::string actfhs_toml(const ValueFit& fit);

/// The published modes, in the order of the constraints.
struct PublishedMode {
  std::string name;
  enum class Vehicle { bare, stabilized, optimized } vehicle;
  enum class Axis { pitch, roll } axis;
  double period_s, damping;
};
const std::vector<PublishedMode>& actfhs_published_modes();

}  // namespace fatmc::fit
