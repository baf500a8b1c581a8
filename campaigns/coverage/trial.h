// One trial of the coverage study: fly, estimate, compare with the sampled response of the very model that
// flew.
#pragma once

#include "campaigns/base/study.h"

namespace fatmc::coverage {

extern const TrialStudy kTrialStudy;

}  // namespace fatmc::coverage
