// Candidate models of records (Wartmann & Greiser, "H"): many windows and orders, those with a small norm of A_K^p that
// repeat the validation maneuvers best, and how far their spread covers what they leave unexplained there.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "campaigns/candidates/model_table.h"
#include "coordinator/cli/record_maneuvers.h"
#include "core/subspace/model_family.h"

namespace fatmc::cli {

struct CandidateArguments : RecordSelection {
  FamilyPlan plan;
  double smallest_norms =
      0.25;             ///< share of the models of an order that pass by their norm; unless `norm` is set
  double norm = 0.0;    ///< a limit of H 4.3 in its place; 0: none
  double share = 0.15;  ///< of the models of an order that become candidates
};

/// One output over all validation maneuvers.
struct SpreadScore {
  std::string output;
  double best_variance_accounted_for = 0.0;    ///< by the best model of the order by d1
  double median_variance_accounted_for = 0.0;  ///< over the candidates
  double error_rms = 0.0;                      ///< of the candidates' mean against the measurement
  double spread_rms = 0.0;                     ///< standard deviation over the candidates
  double covered = 0.0;                        ///< share of samples within 1.96 of those deviations, per cent
};

struct OrderCandidates {
  int order = 0;
  std::size_t models = 0, failed = 0, unstable = 0;
  candidates::Selected selected;
  std::vector<SpreadScore> outputs;  ///< empty where no model could be judged
};

struct RecordCandidates {
  std::vector<std::string> inputs, outputs;
  double rate_hz = 0.0;
  candidates::ModelTable table;         ///< agreement: overall d1 over the validation maneuvers
  std::vector<DiscreteModel> models;    ///< by index in the table; empty matrices where there is none
  std::vector<OrderCandidates> orders;  ///< ascending
  std::string first_failure;
};

/// `progress` is told each past window before its models are made. The error names the file or option to change.
Result<RecordCandidates> record_candidates(const CandidateArguments& arguments,
                                           const std::function<void(int past)>& progress);

}  // namespace fatmc::cli
