// Prints "f q p quantile cdf(quantile)" and "t dof p quantile" lines for stats_reference.py.
#include <cstdio>

#include "core/base/text.h"
#include "core/stats/confidence.h"
#include "core/stats/intervals.h"

int main() {
  using fatmc::shortest;
  for (const double p : {1e-6, 0.01, 0.25, 0.5, 0.75, 0.9, 0.95, 0.99, 0.9999}) {
    for (const double q : {1.0, 2.0, 4.0, 7.0, 10.0, 16.0, 100.0}) {
      const double x = fatmc::f_quantile_2_2q(p, q);
      std::printf("f %s %s %s %s\n", shortest(q).c_str(), shortest(p).c_str(), shortest(x).c_str(),
                  shortest(fatmc::f_cdf_2_2q(x, q)).c_str());
      std::printf("t %s %s %s\n", shortest(q).c_str(), shortest(p).c_str(), shortest(fatmc::t_quantile(p, q)).c_str());
    }
  }
  return 0;
}
