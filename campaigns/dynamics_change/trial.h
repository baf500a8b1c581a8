// One trial of the study of changing dynamics: fly, change the aircraft in flight, watch it with the stability
// monitor.
#pragma once

#include "campaigns/base/study.h"

namespace fatmc::dynamics_change {

extern const TrialStudy kTrialStudy;

}  // namespace fatmc::dynamics_change
