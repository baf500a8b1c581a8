// Models whose errors `fatmc diagnose` looks for bin by bin (response_diagnosis.h): a frequency response, a state-space model, or
// what any model gave for the very record.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "campaigns/base/tree.h"
#include "coordinator/input/response_file.h"
#include "core/base/error.h"
#include "core/record/column_file.h"

namespace fatmc::cli {

enum class ResponseKind { frf, recorded_output, state_space };

struct ResponseModel {
  std::string path, hash;  ///< SHA-256 of the file
  ResponseKind kind = ResponseKind::frf;
  bool diagonal = false;   ///< frf: without the elements off the diagonal
  ResponseTable response;  ///< frf
  Columns series;          ///< recorded_output
  std::vector<std::string> columns;
  Tree state_space;             ///< state_space: its file without band_hz, decoded once the record is known
  std::vector<double> band_hz;  ///< empty, or lower and upper end

  /// Whether its elements can be corrected.
  [[nodiscard]] bool repairable() const { return kind != ResponseKind::recorded_output; }
};

/// "frf", "recorded_output", "state_space", or empty for any other kind or an unreadable file (whose reader reports it).
std::string response_kind(const std::string& model);

Result<ResponseModel> read_response_model(const std::string& path);

/// Spectra of one record in the band, and what the model makes of them.
struct ModelledSpectra {
  std::vector<double> frequency_hz;  ///< of the bins
  Eigen::MatrixXcd input, output, error;
  std::vector<std::string> inputs, outputs;
  Eigen::Matrix<bool, Eigen::Dynamic, Eigen::Dynamic>
      absent;              ///< outputs x inputs: elements that the model does not have
  ResponseTable response;  ///< of the model: at its own frequencies (frf) or at the bins (state_space)
  std::vector<std::string> notes;  ///< one sentence each
};

/// The error names the file and key that do not fit each other.
Result<ModelledSpectra> modelled_spectra(const std::string& record, const ResponseModel& model);

}  // namespace fatmc::cli
