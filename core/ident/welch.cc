#include "core/ident/welch.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "core/ident/aperiodic_windows.h"
#include "core/ident/line_regression.h"
#include "core/ident/mean_spectra.h"

namespace fatmc {
namespace {

/// Periodic Hann window (or ones), of mean square 1 so that white noise keeps its level.
Eigen::VectorXd taper_of(int n, Taper taper) {
  Eigen::VectorXd w = Eigen::VectorXd::Ones(n);
  if (taper == Taper::hann) {
    for (int i = 0; i < n; ++i) w(i) = 0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * i / n);
  }
  return w / std::sqrt(w.squaredNorm() / n);
}

Eigen::MatrixXcd segment_spectrum(const Eigen::MatrixXd& samples, int first, const Eigen::VectorXd& taper, int bins) {
  Eigen::MatrixXd x = samples.middleRows(first, taper.size());
  x.rowwise() -= x.colwise().mean().eval();
  return record_spectrum(taper.asDiagonal() * x, bins);
}

struct Plan {
  int segment = 0, hop = 0, count = 0, first_bin = 1, last_bin = 0;
  double effective = 0.0;
};

Result<Plan> plan(const Measurement& m, const WelchOptions& o) {
  const int samples = static_cast<int>(m.inputs.rows());
  Plan p;
  p.segment = o.segment_samples;
  if (p.segment == 0) p.segment = m.experiment.periods >= 2 ? m.experiment.period_samples : samples / 8 / 2 * 2;
  if (p.segment < 4 || p.segment > samples) {
    return fail(Error{"", 0, "segment", std::to_string(p.segment) + " samples are not in 4 ... " +
                                            std::to_string(samples) + ", the length of the record"});
  }
  if (!(o.overlap >= 0.0 && o.overlap <= 0.9)) return fail(Error{"", 0, "overlap", "must lie in 0 ... 0.9"});
  p.hop = std::max(1, static_cast<int>(std::lround(p.segment * (1.0 - o.overlap))));
  p.count = 1 + (samples - p.segment) / p.hop;
  p.effective = effective_segments(p.count, p.segment, p.hop, o.taper);
  if (std::floor(p.effective) <= m.n_in() || p.count <= m.n_in()) {
    return fail(Error{"", 0, "segment", std::to_string(p.count) + " segments of " + std::to_string(p.segment) +
                                            " samples are too few for " + std::to_string(m.n_in()) +
                                            " inputs, take shorter ones"});
  }
  p.last_bin = (p.segment - 1) / 2;
  if (!m.experiment.lines.empty() && m.experiment.period_samples > 0) {
    const double scale = static_cast<double>(p.segment) / m.experiment.period_samples;
    p.first_bin = std::max(1, static_cast<int>(std::floor(m.experiment.lines.front() * scale)));
    p.last_bin = std::min(p.last_bin, static_cast<int>(std::ceil(m.experiment.lines.back() * scale)));
  }
  const BinBand band = within_limits({p.first_bin, p.last_bin}, m, p.segment);
  if (band.count() < 1) return fail(Error{"", 0, "segment", "no bin of a segment lies in the band, take longer ones"});
  p.first_bin = band.first;
  p.last_bin = band.last;
  return p;
}

/// [Z, R] of all segments at a line: segments x (n_z + n_in).
struct Segments {
  std::vector<Eigen::MatrixXcd> at_bin;

  Segments(const Measurement& m, const Plan& p, Taper taper) {
    const Eigen::VectorXd w = taper_of(p.segment, taper);
    const Eigen::Index n_z = m.n_out() + m.n_in(), n_r = m.references.cols();
    at_bin.assign(static_cast<std::size_t>(p.last_bin - p.first_bin + 1), Eigen::MatrixXcd(p.count, n_z + n_r));
    for (int s = 0; s < p.count; ++s) {
      Eigen::MatrixXcd all(p.last_bin + 1, n_z + n_r);
      all.leftCols(m.n_out()) = segment_spectrum(m.outputs, s * p.hop, w, p.last_bin + 1);
      all.middleCols(m.n_out(), m.n_in()) = segment_spectrum(m.inputs, s * p.hop, w, p.last_bin + 1);
      if (n_r > 0) all.rightCols(n_r) = segment_spectrum(m.references, s * p.hop, w, p.last_bin + 1);
      for (std::size_t k = 0; k < at_bin.size(); ++k) at_bin[k].row(s) = all.row(p.first_bin + static_cast<int>(k));
    }
  }
};

}  // namespace

double effective_segments(int segments, int segment_samples, int hop, Taper taper) {
  const Eigen::VectorXd w = taper_of(segment_samples, taper);
  double sum = 1.0;
  for (int m = 1; m < segments && m * hop < segment_samples; ++m) {
    const Eigen::Index rest = segment_samples - m * hop;
    const double rho = w.head(rest).dot(w.tail(rest)) / w.squaredNorm();
    sum += 2.0 * (1.0 - static_cast<double>(m) / segments) * rho * rho;
  }
  return segments / sum;
}

Result<ResponseEstimate> welch(const Measurement& m, const WelchOptions& options) {
  const Result<Plan> planned = plan(m, options);
  if (!planned) return fail(planned.error());
  const Plan& p = *planned;
  const Segments segments(m, p, options.taper);
  ResponseEstimate out;
  FrmEstimate& e = out.frm;
  e.n_out = m.n_out();
  e.n_in = m.n_in();
  e.indirect = m.indirect();
  const int n_z = e.n_out + e.n_in;
  for (int bin = p.first_bin; bin <= p.last_bin; ++bin) {
    e.lines.push_back(bin);
    e.frequency_hz.push_back(bin * m.experiment.rate_hz / p.segment);
  }
  size_estimate(e);
  e.q = static_cast<int>(std::floor(p.effective)) - e.n_in;
  out.coherence.resize(e.n_out, 1, e.line_count());
  // The QR judges by `count` segments, of which `effective` are independent.
  const double share = p.count / p.effective;
  const double residual = (p.count - e.n_in) / (p.effective - e.n_in) / share;
  for (int k = 0; k < e.line_count(); ++k) {
    const Eigen::MatrixXcd& z = segments.at_bin[static_cast<std::size_t>(k)];
    const Eigen::MatrixXcd known = e.indirect ? z.rightCols(e.n_in) : z.middleCols(e.n_out, e.n_in);
    LineRegression r = regress_line(known, z.leftCols(e.indirect ? n_z : e.n_out), e.n_in);
    for (int i = 0; i < e.n_out; ++i) {
      const double total = z.col(i).squaredNorm();
      const double left = r.C_Z(i, i).real() * (p.count - e.n_in);
      out.coherence[k](i, 0) = total > 0.0 && r.condition < kSingularCondition ? std::clamp(1.0 - left / total, 0.0, 1.0) : 0.0;
    }
    r.A *= share;
    r.C_Z *= residual;
    store_input_quality(e, k, z.middleCols(e.n_out, e.n_in).colwise().mean().transpose());
    store_line(e, k, r);
  }
  out.notes.push_back(std::to_string(p.count) + " segments of " + std::to_string(p.segment) + " samples, hop " +
                      std::to_string(p.hop) + ", worth " + std::to_string(static_cast<int>(p.effective)) +
                      " independent ones");
  return out;
}

}  // namespace fatmc
