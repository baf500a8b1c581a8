// Trials of the hidden-effect study: draw, fly, record as a stranger would, diagnose with the unchanged model, compare.
#pragma once

#include "campaigns/base/study.h"

namespace fatmc::hidden_effect {

extern const TrialStudy kTrialStudy;

}  // namespace fatmc::hidden_effect
