// A diagnosis as a page: verdict, where, overlays before and after, what is left.
#pragma once

#include <string>
#include <vector>

#include "coordinator/cli/diagnosis_files.h"

namespace fatmc::cli {

/// Responses of one record, order of response_vector.
struct ResponseOverlay {
  std::string record;
  bool holdout = false;
  std::vector<double> frequency_hz;
  Eigen::VectorXcd measured, before, after;
  Eigen::VectorXd deviation;  ///< of an estimate of the model's flights, |G|
};

std::string diagnosis_html(const DiagnosisPage& page, const std::vector<ResponseOverlay>& overlays,
                           const std::vector<MapEntry>& map);

}  // namespace fatmc::cli
