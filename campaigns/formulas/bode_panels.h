// A response as two panels: magnitude in dB and phase in degrees, over a logarithmic frequency axis.
#pragma once

#include <Eigen/Core>
#include <complex>
#include <string>
#include <vector>

#include "campaigns/base/figure.h"

namespace fatmc {

struct BodeCurve {
  std::string name;
  plot::Hue hue = plot::Hue::blue;
  plot::Dash dash = plot::Dash::solid;
  std::vector<std::complex<double>> response;  ///< zeros (round-off below 1e-9) are gaps
};

struct BodePanels {
  plot::Panel magnitude, phase;
};

/// Phases lie in (-360, 0] degrees; where they jump between the ends the line breaks. A response that vanishes everywhere
/// says so in the title.
BodePanels bode_panels(const std::string& title, const std::vector<double>& frequency_hz,
                       const std::vector<BodeCurve>& curves);

/// Element (output, input) of every matrix.
std::vector<std::complex<double>> element(const std::vector<Eigen::Matrix3cd>& matrices, int output,
                                          int input);

}  // namespace fatmc
