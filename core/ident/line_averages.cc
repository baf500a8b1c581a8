#include "core/ident/line_averages.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/check.h"
#include "core/ident/line_regression.h"
#include "core/ident/mean_spectra.h"
#include "core/ident/transient_windows.h"

namespace fatmc {
namespace {

std::size_t index(int i) { return static_cast<std::size_t>(i); }

Status check(std::span<const Measurement> experiments) {
  FATMC_CHECK(!experiments.empty() && !experiments.front().experiment.lines.empty(), "an experiment with lines");
  const Measurement& first = experiments.front();
  if (first.experiment.periods < 2) {
    return fail(Error{"", 0, "periods", "averages need at least 2 whole periods, the record holds " +
                                            std::to_string(first.experiment.periods)});
  }
  for (const Measurement& m : experiments) {
    const PeriodicExperiment &a = m.experiment, &b = first.experiment;
    if (a.lines != b.lines || a.period_samples != b.period_samples || a.periods != b.periods ||
        a.rate_hz != b.rate_hz || m.n_out() != first.n_out() || m.n_in() != first.n_in() ||
        m.references.cols() != first.references.cols()) {
      return fail("the experiments differ in rate, period, number of periods, lines or channels: use records of one "
                  "design");
    }
  }
  const auto count = static_cast<int>(experiments.size());
  if (count > 1 && count < first.n_in()) {
    return fail(std::to_string(count) + " experiments for " + std::to_string(first.n_in()) +
                " inputs: record at least one experiment an input");
  }
  if (count == 1 && first.n_in() > 1 && first.indirect()) {
    return fail("one experiment with references and " + std::to_string(first.n_in()) +
                " inputs: record one experiment an input, or use --method lpm, which smooths over frequency");
  }
  return {};
}

/// The input that line k of a zippered experiment excites; -1 where there are several. Each input is measured against
/// its own largest line.
int zippered_input(const Eigen::MatrixXcd& inputs, const Eigen::VectorXd& largest, int k) {
  constexpr double kSilent = 0.1;
  int found = -1;
  for (int j = 0; j < static_cast<int>(inputs.cols()); ++j) {
    if (std::abs(inputs(k, j)) < kSilent * largest(j)) continue;
    if (found >= 0) return -1;
    found = j;
  }
  return found;
}

std::complex<double> bias_of_ratio(const FrmEstimate& e, int k, int i, std::complex<double> u, int channel) {
  const auto noise = e.C_Z_noise[k];
  const double s_u = std::sqrt(std::max(0.0, noise(channel, channel).real()));
  const double s_y = std::sqrt(std::max(0.0, noise(i, i).real()));
  const std::complex<double> g = e.G[k](i, channel - e.n_out);
  const double y = std::abs(g * u);
  if (!(s_u > 0.0) || !(y > 0.0)) return 0.0;
  const std::complex<double> rho =
      s_y > 0.0 ? noise(i, channel) / (s_u * s_y) * std::conj(g) / std::abs(g) : std::complex<double>(0.0);
  const double output_snr = s_y > 0.0 ? y / s_y : std::numeric_limits<double>::infinity();
  return g * relative_etfe_bias(std::abs(u) / s_u, output_snr, rho);
}

/// Line k of a single experiment of several inputs, of which `j` alone is excited.
void store_zippered(FrmEstimate& e, int k, int j, const Eigen::VectorXcd& z) {
  const std::complex<double> u = z(e.n_out + j);
  const Eigen::VectorXcd g = z.head(e.n_out) / u;
  e.estimated[k](j, 0) = 1;
  e.regressor_condition[index(k)] = 1.0;
  e.G[k].col(j) = g;
  e.B[k](j, j) = 1.0 / std::norm(u);
  Eigen::MatrixXcd v = Eigen::MatrixXcd::Zero(e.n_out, e.n_out + e.n_in);
  v.leftCols(e.n_out).setIdentity();
  v.col(e.n_out + j) = -g;
  e.C_V_noise[k] = v * e.C_Z_noise[k] * v.adjoint();
  e.C_V[k] = e.C_V_noise[k];
  e.C_Z[k] = e.C_Z_noise[k].topLeftCorner(e.n_out, e.n_out);
}

/// A line at which an input is round-off would give a ratio of two round-offs: refused, since its noise may be
/// round-off, too, and look small. Several inputs are judged by the condition of their line.
Status check_excitation(const std::vector<MeanSpectra>& all, const FrmEstimate& e) {
  constexpr double kRoundOff = 1e-12;
  if (e.n_in != 1) return {};
  Eigen::VectorXd excited = Eigen::VectorXd::Zero(e.line_count());
  for (const MeanSpectra& a : all) excited = excited.cwiseMax(a.mean.col(e.n_out).cwiseAbs());
  const double least = kRoundOff * excited.maxCoeff();
  for (int k = 0; k < e.line_count(); ++k) {
    if (excited(k) > least) continue;
    return fail(Error{"", 0, "line " + std::to_string(e.lines[index(k)]),
                      "the input is not excited there (round-off of its other lines): leave the line out of "
                      "excited_lines"});
  }
  return {};
}

Status estimate_zippered(const MeanSpectra& a, ResponseEstimate& out) {
  FrmEstimate& e = out.frm;
  e.estimated.resize(e.n_in, 1, e.line_count());
  const Eigen::MatrixXcd inputs = a.mean.rightCols(e.n_in);
  const Eigen::VectorXd largest = inputs.cwiseAbs().colwise().maxCoeff();
  for (int k = 0; k < e.line_count(); ++k) {
    const int j = zippered_input(inputs, largest, k);
    if (j < 0) {
      return fail("line " + std::to_string(e.lines[index(k)]) + " excites several inputs: record one experiment an "
                  "input, give each input lines of its own, or use --method lpm");
    }
    e.C_Z_noise[k] = a.noise[k];
    store_input_quality(e, k, inputs.row(k).transpose());
    store_zippered(e, k, j, a.mean.row(k).transpose());
  }
  out.notes.push_back("zippered lines: each line holds the column of the input that it excites");
  return {};
}

void estimate_experiments(const std::vector<MeanSpectra>& all, FrmEstimate& e) {
  const auto count = static_cast<Eigen::Index>(all.size());
  const int n_z = e.n_out + e.n_in;
  Eigen::MatrixXcd z(count, n_z), reference(count, e.n_in);
  for (int k = 0; k < e.line_count(); ++k) {
    for (Eigen::Index m = 0; m < count; ++m) {
      const MeanSpectra& a = all[static_cast<std::size_t>(m)];
      z.row(m) = a.mean.row(k);
      reference.row(m) = a.mean.row(k).tail(e.n_in);
      if (e.indirect) reference.row(m) = a.reference.row(k);
      e.C_Z_noise[k] += a.noise[k] / static_cast<double>(count);
    }
    // The largest input over the experiments speaks for the line.
    Eigen::VectorXcd inputs(e.n_in);
    for (int j = 0; j < e.n_in; ++j) {
      Eigen::Index largest = 0;
      z.col(e.n_out + j).cwiseAbs().maxCoeff(&largest);
      inputs(j) = z(largest, e.n_out + j);
    }
    store_input_quality(e, k, inputs);
    store_line(e, k, regress_line(reference, e.indirect ? z : Eigen::MatrixXcd(z.leftCols(e.n_out)), e.n_in));
  }
}

}  // namespace

std::complex<double> relative_etfe_bias(double input_snr, double output_snr, std::complex<double> rho) {
  FATMC_CHECK(input_snr >= 0.0 && output_snr > 0.0, "amplitudes over standard deviations");
  return -std::exp(-input_snr * input_snr) * (1.0 - rho * (input_snr / output_snr));
}

Result<ResponseEstimate> estimate_by_line_averages(std::span<const Measurement> experiments,
                                                   const LineAverageOptions& options) {
  if (Status status = check(experiments); !status) return fail(status.error());
  const Measurement& first = experiments.front();
  const PeriodicExperiment& design = first.experiment;
  TransientWindows windows;
  if (options.average == LineAverage::transient) {
    int bins = 10;
    if (options.n_transient) {
      bins = 2 * *options.n_transient;
    } else if (design.periods >= 5) {
      bins = design.periods + options.order;
    }
    if (options.order < 0 || options.order > 8) {
      return fail(Error{"", 0, "order", std::to_string(options.order) + " is not in 0 ... 8"});
    }
    if (bins <= options.order + 1) {
      return fail(Error{"", 0, "n-transient", std::to_string(bins) + " bins leave no degree of freedom, take " +
                                                  std::to_string((options.order + 3) / 2) + " or more on each side"});
    }
    windows = TransientWindows(design.lines, design.period_samples, design.periods, bins, options.order);
    if (windows.line_count() == 0) {
      return fail(Error{"", 0, "n-transient", "there are fewer than " + std::to_string(bins) +
                                                  " non-excited DFT bins in the excited band, take a smaller number"});
    }
  }
  std::vector<MeanSpectra> all;
  for (const Measurement& m : experiments) {
    all.push_back(options.average == LineAverage::periods ? average_periods(m) : remove_transient(m, windows));
  }

  ResponseEstimate out;
  FrmEstimate& e = out.frm;
  e.n_out = first.n_out();
  e.n_in = first.n_in();
  e.indirect = first.indirect();
  e.lines = design.lines;
  for (const int line : design.lines) e.frequency_hz.push_back(line * design.rate_hz / design.period_samples);
  size_estimate(e);
  if (Status status = check_excitation(all, e); !status) return fail(status.error());
  const int count = static_cast<int>(experiments.size());
  e.q_noise = count * all.front().q;
  e.q = count > e.n_in ? count - e.n_in : e.q_noise;
  if (count == 1 && e.n_in > 1) {
    if (Status status = estimate_zippered(all.front(), out); !status) return fail(status.error());
  } else {
    estimate_experiments(all, e);
  }
  if (count == 1) {
    out.bias.resize(e.n_out, e.n_in, e.line_count());
    for (int k = 0; k < e.line_count(); ++k) {
      for (int j = 0; j < e.n_in; ++j) {
        if (!e.holds(k, j) || e.status[index(k)] != LineStatus::ok) continue;
        for (int i = 0; i < e.n_out; ++i) {
          out.bias[k](i, j) = std::abs(bias_of_ratio(e, k, i, all.front().mean(k, e.n_out + j), e.n_out + j));
        }
      }
    }
  }
  if (count == e.n_in && count > 1) {
    out.notes.push_back("as many experiments as inputs: the variance is that of the noise, nonlinear distortion is not "
                        "in it; one more experiment shows it");
  }
  return out;
}

}  // namespace fatmc
