// What `fatmc estimate` writes and prints of an estimate.
#pragma once

#include <string>

#include "coordinator/cli/estimate_record.h"

namespace fatmc::cli {

struct EstimateArguments : EstimateOptions {
  std::string method = "lpm";
  std::string directory;
  bool plots = false;
  std::string reference;  ///< empty, or what to compare the plots with
  bool bias_variants = false;  ///< the bias with every constant into estimate.json
};

/// line,frequency_hz,output,input,re,im,variance,bias; the last field is empty where the method has no bias
/// estimate.
std::string frm_csv(const EstimatedRecord& e);
std::string estimate_json(const EstimateArguments& arguments, const EstimatedRecord& e);
void print_summary(const EstimateArguments& arguments, const EstimatedRecord& e);

}  // namespace fatmc::cli
