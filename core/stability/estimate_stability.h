// From a frequency response estimate to the confidence that its loop is stable: every line judged, then the band.
//
//   record -> FastLpm, interpolation_bias (core/ident) -> judge_estimate -> p(B)      (T sections 2.8.2-2.8.5)
//
// Pure: a campaign trial, a monitor's epoch and the command call the same function.
#pragma once

#include <Eigen/Core>
#include <complex>
#include <optional>
#include <vector>

#include "core/ident/frm_estimate.h"
#include "core/ident/matrix_stack.h"
#include "core/robust/confident_stability.h"
#include "core/robust/nominal_model.h"

namespace fatmc {

/// What estimates are judged against; computed once for a grid of lines.
struct NominalLoop {
  MatrixStack<std::complex<double>> response;  ///< G_n at each line, n_out × n_in; stable under `controller`
  Eigen::MatrixXcd controller;                 ///< K of u = K (r − y), n_in × n_out
};

/// G_n of a sampled model at the lines of `frequency_hz`.
NominalLoop nominal_loop(const SampledModel& model, const Eigen::Ref<const Eigen::MatrixXd>& controller,
                         const std::vector<double>& frequency_hz, double rate_hz);

/// Scalings of every line, kept from epoch to epoch: a window that moves on by a little starts next to its optimum.
/// Empty: cold. The bounds agree with those of a cold start to the accuracy that SsvBounds states, not bit for bit.
using EstimateScalings = std::vector<StabilityScalings>;

struct EstimateStability {
  std::vector<LineStability> lines;
  std::vector<double> snr_min_db;  ///< smallest over the inputs (5.10), between ±kSnrLimitDb
  BandStability band;
};

/// 20 log10 of an input SNR is kept within this: noise-free records have no finite one, inputs below their noise none
/// that is positive.
inline constexpr double kSnrLimitDb = 300.0;

/// Smallest input SNR of line k in dB, 20 log10 min_j (|U^_j| − s_j)/s_j (5.10).
double smallest_input_snr_db(const FrmEstimate& estimate, int k);

/// The line as core/robust judges it: σ² = B_jj C_V,ii, q, SNR. `bias` as of interpolation_bias.
EstimatedLine estimated_line(const FrmEstimate& estimate, const MatrixStack<double>& bias, int k);

/// Judges every line and combines them. `nominal` has one response a line. A line without an estimate fails with a
/// reason and p = 0. `scalings`, if given, is the start of every line's ssv and left at its optimum. Without it every
/// line starts cold: from one line to the next estimates move so much that the neighbour's scalings save nothing
/// (bench_stability: 17 µs a line cold, 19 µs from the neighbour), and no line depends on another.
EstimateStability judge_estimate(const FrmEstimate& estimate, const MatrixStack<double>& bias, const NominalLoop& nominal,
                                 const StabilityOptions& options = {}, EstimateScalings* scalings = nullptr);

/// Damping of the resonances between the lines that an allowance for intergrid error covers, largest over the gaps of
/// the grid (intergrid.h); nothing for fewer than two lines.
struct IntergridCover {
  double damping = 0.0;
  double frequency_hz = 0.0;  ///< middle of the gap that decides
  double spacing_hz = 0.0;
};
std::optional<IntergridCover> intergrid_cover(const std::vector<double>& frequency_hz, double intergrid);

}  // namespace fatmc
