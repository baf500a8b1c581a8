// One trial of the candidates study: all models of a fixed block of consecutive past windows, identified with
// shared factorisations, validated and analysed. The flight test is flown once a process and cell.
#pragma once

#include "campaigns/base/study.h"

namespace fatmc::candidates {

extern const TrialStudy kTrialStudy;

}  // namespace fatmc::candidates
