// One trial of the stability study: fly, estimate, judge nominal and robust stability line by line (T 5.4-5.6).
#pragma once

#include "campaigns/base/study.h"

namespace fatmc::stability {

extern const TrialStudy kTrialStudy;

}  // namespace fatmc::stability
