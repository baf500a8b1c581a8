#include "core/stats/confidence_regions.h"

#include <cmath>

#include "core/base/check.h"
#include "core/stats/confidence.h"
#include "core/stats/lawley_hotelling.h"

namespace fatmc {

std::string_view name_of(RegionKind kind) {
  switch (kind) {
    case RegionKind::univariate:
      return "univariate";
    case RegionKind::bonferroni:
      return "bonferroni";
    case RegionKind::simultaneous:
      return "simultaneous";
    case RegionKind::joint:
      return "joint";
  }
  return "";
}

std::optional<double> region_radius(RegionKind kind, double p, int n_out, int n_in, double q) {
  FATMC_CHECK(n_out >= 1 && n_in >= 1 && q > 0.0, "a matrix and degrees of freedom");
  switch (kind) {
    case RegionKind::univariate:
      return confidence_radius(1.0, p, q);
    case RegionKind::bonferroni:
      return confidence_radius(1.0, bonferroni_level(p, n_out * n_in), q);
    case RegionKind::simultaneous:
    case RegionKind::joint:
      break;
  }
  if (q < n_out) return std::nullopt;
  return std::sqrt(ComplexLawleyHotelling(n_out, n_in, q).quantile(p).value);
}

}  // namespace fatmc
