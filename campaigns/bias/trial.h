// One trial of the bias study: fly in calm air, estimate, compare with the sampled response of the model that flew.
#pragma once

#include "campaigns/base/study.h"

namespace fatmc::bias {

extern const TrialStudy kTrialStudy;

}  // namespace fatmc::bias
