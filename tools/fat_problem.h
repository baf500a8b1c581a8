// The fit of the FAT: what is known, what is free with which prior, what is printed.
//
// Given: mass, span, trim, actuators, IMU (T 3.2, A.2, A.5). Fitted: all poles of Table A-5, T_theta1,
// T_theta2, the zero pair of r/zeta_c and the zero of r/xi_c. Twenty-odd derivatives against
// fifteen figures: priors of what such a sailplane-like aircraft has choose among the solutions.
#pragma once

#include "tools/fit_problem.h"

namespace fatmc::fit {

Problem fat_problem();

}  // namespace fatmc::fit
