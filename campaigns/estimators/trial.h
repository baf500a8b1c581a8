// One trial of chapter 3: one axis is excited, and every estimator judges the same flight.
//
// The spec is that of a flown study (campaigns/flown/flown_cell.h); exactly one of the three amplitudes is above zero, and
// the estimators have one input (the command of that axis) and one output (its rate).
#pragma once

#include "campaigns/base/study.h"

namespace fatmc::estimators {

extern const TrialStudy kTrialStudy;

}  // namespace fatmc::estimators
