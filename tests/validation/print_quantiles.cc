// Prints "f q p quantile cdf(quantile)", "t dof p quantile" and "r s_u s_y re(rho) im(rho) radius probability" lines for
// stats_reference.py, "j n_out n_in q p quantile error cdf(quantile)" lines for joint_region_reference.py.
#include <cstdio>

#include "core/base/text.h"
#include "core/stats/confidence.h"
#include "core/stats/intervals.h"
#include "core/stats/lawley_hotelling.h"
#include "core/stats/ratio_density.h"

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
  for (const double input : {0.02, 0.1, 0.4}) {
    for (const double output : {0.1, 0.3, 1.0}) {
      for (const std::complex<double> rho : {std::complex<double>(0.0), std::complex<double>(-0.6, 0.5)}) {
        for (const double size : {0.5, 2.0, 5.0}) {
          const double radius = size * std::hypot(input, output);
          std::printf("r %s %s %s %s %s %s\n", shortest(input).c_str(), shortest(output).c_str(),
                      shortest(rho.real()).c_str(), shortest(rho.imag()).c_str(), shortest(radius).c_str(),
                      shortest(fatmc::ratio_disc_probability(radius, {input, output, rho})).c_str());
        }
      }
    }
  }
  const int sizes[][3] = {{3, 3, 10}, {3, 3, 3}, {1, 1, 10}, {3, 1, 10}, {1, 3, 10}, {2, 3, 4}, {3, 2, 4}, {6, 3, 10}, {4, 4, 40}};
  for (const auto& [n_out, n_in, q] : sizes) {
    const fatmc::ComplexLawleyHotelling law(n_out, n_in, q);
    for (const double p : {0.1, 0.5, 0.95, 0.99}) {
      const auto t = law.quantile(p);
      std::printf("j %d %d %d %s %s %s %s\n", n_out, n_in, q, shortest(p).c_str(), shortest(t.value).c_str(),
                  shortest(t.error).c_str(), shortest(law.distribution(t.value).value).c_str());
    }
  }
  return 0;
}
