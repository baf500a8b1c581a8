// Phases on an axis from -180 to 180 deg: curves and bands that leave the panel on one side come back on the
// other.
#pragma once

#include <vector>

#include "campaigns/base/figure.h"

namespace fatmc::plot {

/// Phases in deg without jumps: each within 180 deg of the one before. All finite.
std::vector<double> unwrapped(std::vector<double> deg);

/// `low` ... `high` about an unwrapped phase as it is seen between ±180 deg: every turn moved there, with the
/// points next to it, so that it runs to the edge of the panel, and gaps between the turns. A curve is a band
/// with both sides equal.
Band turns(const std::vector<double>& x, const std::vector<double>& low, const std::vector<double>& high);

}  // namespace fatmc::plot
