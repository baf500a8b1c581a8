// What a cell of the candidates study flies, identifies and selects. Keys: spec.toml of this folder.
#pragma once

#include <string>
#include <vector>

#include "campaigns/base/campaign_spec.h"
#include "core/base/error.h"
#include "core/subspace/discrete_model.h"
#include "core/subspace/pbsid_opt.h"

namespace fatmc::candidates {

/// Channels of H (2), in this order.
inline constexpr int kInputs = 4, kOutputs = 8;
const std::vector<std::string>& input_names();
const std::vector<std::string>& output_names();

/// The aircraft that flies: x[n+1] = A x + B u, y = C x, outputs of H (2) in SI and rad, controls in per cent.
struct Truth {
  DiscreteModel model;
  double rate_hz = 25.0;
};

/// Sweeps and multisteps of H Table 1, and what disturbs them.
struct FlightTest {
  int sweep_samples = 2485;                                          ///< of each of the eight sweeps
  int multistep_samples = 300;                                       ///< of each of the eight multisteps
  std::vector<double> sweep_amplitude_pct, multistep_amplitude_pct;  ///< by control
  double sweep_low_hz = 0.1, sweep_high_hz = 2.0;
  double multistep_unit_s = 0.7;  ///< 3-2-1-1 units of it
  std::vector<double> noise;      ///< standard deviation of each output's measurement, SI and rad
  double gust_m_s = 0.0, gust_time_constant_s = 1.0;  ///< u, v, w: first-order Gauss-Markov
  /// Share of the gains of H (14) in the loop, fed back a sample late; 0: open loop.
  double scas = 0.0;
};

struct Identification {
  std::vector<int> pasts;  ///< M_p of H (3), descending
  int block = 5;           ///< consecutive p a trial
  int lowest_order = 8, highest_order = 20;
  RegularizationOptions regularization;
  bool lambda_for_each_past = true;
  FinalRegression final_regression = FinalRegression::paper;

  [[nodiscard]] std::size_t blocks() const;
  /// Of trial `index`, descending; empty beyond the last block.
  [[nodiscard]] std::vector<int> block_pasts(std::size_t index) const;
};

/// The two steps of H 4.3 for one order: spectral norm of A_K^p below a limit, then the best by d1.
struct Selection {
  int order = 12;
  /// The limit. H calls it user-defined, and gives 1e-10 for n = 12, 1e-3 for n = 18.
  double norm = 1e-10;
  /// In its place, a share of the models of the order: those of the smallest norms. 0: `norm` counts.
  double smallest_norms = 0.0;
  double share = 0.15;  ///< of all models of that order that are taken

  /// What tells it from another selection of the same order.
  [[nodiscard]] std::string limit_text() const;
};

struct CandidatesSpec {
  Truth truth;
  FlightTest flight;
  Identification identification;
  std::vector<double> weights;  ///< w_i of the overall d1, H (11), by output
  std::vector<Selection> selections;
};

/// Decodes the spec of one cell (prepared_trials.h, spec_of_cell).
Result<CandidatesSpec> decode_candidates(const CampaignSpec& own);

}  // namespace fatmc::candidates
