// What `fatmc estimate` writes and prints of an estimate.
#pragma once

#include <string>
#include <vector>

#include "core/ident/estimators.h"
#include "core/record/record.h"

namespace fatmc::cli {

struct EstimateArguments {
  std::vector<std::string> records;
  std::string meta;
  std::string method = "lpm";
  EstimatorOptions options;
  int skip_periods = 0;
  bool speed_correction = false;
  std::string directory;
};

struct EstimatedRecord {
  EstimationMethod method = EstimationMethod::lpm;
  Record record;  ///< the first one; the others agree with it in all that is reported
  ResponseEstimate response;
  double speed_factor = 1.0;
};

/// line,frequency_hz,output,input,re,im,variance,bias; the last field is empty where the method has no bias estimate.
std::string frm_csv(const EstimatedRecord& e);
std::string estimate_json(const EstimateArguments& arguments, const EstimatedRecord& e);
void print_summary(const EstimateArguments& arguments, const EstimatedRecord& e);

}  // namespace fatmc::cli
