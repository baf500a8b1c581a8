// A figure as it is printed.
#pragma once

namespace fatmc::formulas {

struct Printed {
  double value = 0.0;
  int digits = 0;  ///< significant
};

}  // namespace fatmc::formulas
