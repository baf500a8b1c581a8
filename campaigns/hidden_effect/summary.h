// Tables of the hidden-effect study: rates with Wilson's intervals, errors, the confusion matrix.
#pragma once

#include "campaigns/base/study.h"

namespace fatmc::hidden_effect {

extern const SummaryStudy kSummaryStudy;

}  // namespace fatmc::hidden_effect
