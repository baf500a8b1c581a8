// The response that an estimate is compared with, at the estimate's lines.
#pragma once

#include <complex>
#include <string>

#include "coordinator/cli/estimate_record.h"

namespace fatmc::cli {

/// Responses to compare with, at the estimate's lines; NaN where the reference has none.
struct ReferenceResponse {
  std::string name;
  MatrixStack<std::complex<double>> response;  ///< n_out x n_in, a line
};

/// The reference at the lines of the estimate: an frm.csv (linear between its lines, none outside), or the
/// TOML of a MODEL as `fatmc stability` takes it.
Result<ReferenceResponse> read_reference_response(const std::string& path, const EstimatedRecord& e);

}  // namespace fatmc::cli
