// One trial of the variance study: fly, estimate, keep estimate and estimated variance.
#pragma once

#include "campaigns/base/study.h"

namespace fatmc::variance {

extern const TrialStudy kTrialStudy;

}  // namespace fatmc::variance
