// One trial under conditions that T only mentions: other turbulence, gyros, gain, with or without turn coordinator. Fly,
// estimate by the fast LPM, compare with the sampled response of the very model that flew.
#pragma once

#include "campaigns/base/study.h"

namespace fatmc::conditions {

extern const TrialStudy kTrialStudy;

}  // namespace fatmc::conditions
