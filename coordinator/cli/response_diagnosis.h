// `fatmc diagnose` for models that are a response, a linear model or a series, of any process:
//
//   kind = "frf"                 kind = "recorded_output"      # what a model gave for this very record
//   response = "frm.csv"         data = "model.csv"
//   elements = "diagonal"        output = ["q", "p"]           # its columns, in the order of the record's outputs
//   band_hz = [0.5, 40.0]        band_hz = [0.1, 2.0]          # optional
//
//   kind = "state_space"         # keys of coordinator/input/state_space_model.h, and band_hz
// An frf with elements = "diagonal" has no others, whatever its file holds. What of the model's error is a response to the inputs
// is missing in the model: a cross coupling where the model has no such element, an error of the element where it has. What is
// incoherent stays unknown. A recorded output cannot be repaired: there the answer says where, and unknown.
#pragma once

#include <string>
#include <vector>

#include "core/base/error.h"

namespace fatmc::cli {

struct ResponseDiagnosisFiles {
  std::vector<std::pair<std::string, std::string>>
      files;            ///< name, text; frm.csv and model.toml where the model can be repaired
  std::string summary;  ///< for the terminal
};

Result<ResponseDiagnosisFiles> diagnose_response(const std::string& model,
                                                 const std::vector<std::string>& records,
                                                 const std::vector<std::string>& holdout);

}  // namespace fatmc::cli
