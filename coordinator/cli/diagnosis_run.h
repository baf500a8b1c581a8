// The work of `fatmc diagnose`: bases from the cache or anew, diagnosis, repetition, figures of the gap.
#pragma once

#include <string>
#include <vector>

#include "coordinator/cli/diagnosis_files.h"
#include "coordinator/cli/diagnosis_report.h"
#include "core/discrepancy/separability.h"

namespace fatmc::cli {

struct DiagnosisRunOptions {
  bool until_consistent = false;
  bool separability = false;  ///< which effects these records could tell apart
  std::vector<std::string> excluded;
  int flights = 1000;
  int threads = 0;
  std::string cache;  ///< folder
};

struct DiagnosisRun {
  // The page points into these.
  std::unique_ptr<DiagnosedModel> model;
  std::vector<std::unique_ptr<DiagnosedRecord>> records;
  DiagnosisPage page;
  std::vector<ResponseOverlay> overlays;
  std::vector<MapEntry> map;
  std::vector<Separation> separations;
};

Result<DiagnosisRun> run_diagnosis(const std::string& model, const std::vector<std::string>& records,
                                   const std::vector<std::string>& holdout,
                                   const DiagnosisRunOptions& options);

std::string read_file_bytes(const std::string& path);

}  // namespace fatmc::cli
