#include "core/ident/mean_spectra.h"

#include <cmath>

#include "core/base/check.h"
#include "core/signal/dft.h"

namespace fatmc {
namespace {

std::size_t index(int i) { return static_cast<std::size_t>(i); }

void add_reference(const Measurement& m, MeanSpectra& out) {
  if (!m.indirect()) return;
  const PeriodicExperiment& e = m.experiment;
  const Eigen::MatrixXcd bins = record_spectrum(m.references, e.periods * e.lines.back() + 1);
  out.reference.resize(static_cast<Eigen::Index>(e.lines.size()), bins.cols());
  for (std::size_t k = 0; k < e.lines.size(); ++k) {
    out.reference.row(static_cast<Eigen::Index>(k)) = bins.row(e.periods * e.lines[k]);
  }
}

}  // namespace

Eigen::MatrixXcd record_spectrum(const Eigen::Ref<const Eigen::MatrixXd>& samples, int bin_count) {
  const RealDft dft(static_cast<int>(samples.rows()));
  Eigen::MatrixXcd out(bin_count, samples.cols());
  for (Eigen::Index c = 0; c < samples.cols(); ++c) {
    dft.transform({samples.col(c).data(), index(dft.size())}, {out.col(c).data(), index(bin_count)});
  }
  return out;
}

MeanSpectra average_periods(const Measurement& m) {
  const PeriodicExperiment& e = m.experiment;
  const int lines = static_cast<int>(e.lines.size()), n_z = m.n_out() + m.n_in(), periods = e.periods;
  std::vector<Eigen::MatrixXcd> z(index(lines), Eigen::MatrixXcd(n_z, periods));
  for (int l = 0; l < periods; ++l) {
    const auto rows = Eigen::seqN(static_cast<Eigen::Index>(l) * e.period_samples, e.period_samples);
    const Eigen::MatrixXcd y = record_spectrum(m.outputs(rows, Eigen::all), e.lines.back() + 1);
    const Eigen::MatrixXcd u = record_spectrum(m.inputs(rows, Eigen::all), e.lines.back() + 1);
    for (int k = 0; k < lines; ++k) {
      z[index(k)].col(l) << y.row(e.lines[index(k)]).transpose(), u.row(e.lines[index(k)]).transpose();
    }
  }
  MeanSpectra out;
  out.q = periods - 1;
  out.mean.resize(lines, n_z);
  out.noise.resize(n_z, n_z, lines);
  for (int k = 0; k < lines; ++k) {
    const Eigen::VectorXcd mean = z[index(k)].rowwise().mean();
    const Eigen::MatrixXcd scatter = z[index(k)].colwise() - mean;
    out.mean.row(k) = std::sqrt(static_cast<double>(periods)) * mean.transpose();
    out.noise[k] = scatter * scatter.adjoint() / static_cast<double>(out.q);
  }
  add_reference(m, out);
  return out;
}

MeanSpectra remove_transient(const Measurement& m, const TransientWindows& windows) {
  const PeriodicExperiment& e = m.experiment;
  const int lines = windows.line_count(), n_z = m.n_out() + m.n_in(), q = windows.q(), count = windows.count();
  FATMC_CHECK(lines == static_cast<int>(e.lines.size()), "windows of these lines");
  Eigen::MatrixXcd z(windows.bin_count(), n_z);
  z << record_spectrum(m.outputs, windows.bin_count()), record_spectrum(m.inputs, windows.bin_count());
  MeanSpectra out;
  out.q = q;
  out.mean.resize(lines, n_z);
  out.noise.resize(n_z, n_z, lines);
  Eigen::MatrixXcd window(count, n_z);
  for (int k = 0; k < lines; ++k) {
    for (int i = 0; i < count; ++i) window.row(i) = z.row(windows.bins(k)[index(i)]);
    const Eigen::Map<const Eigen::VectorXd> weights(windows.weights(k).data(), count);
    const Eigen::Map<const Eigen::MatrixXd> complement(windows.complement(k).data(), count, q);
    out.mean.row(k) = z.row(e.periods * e.lines[index(k)]) - weights.transpose().cast<std::complex<double>>() * window;
    const Eigen::MatrixXcd residual = (complement.transpose().cast<std::complex<double>>() * window).transpose();
    out.noise[k] = windows.mu_poly(k) / q * residual * residual.adjoint();
  }
  add_reference(m, out);
  return out;
}

}  // namespace fatmc
