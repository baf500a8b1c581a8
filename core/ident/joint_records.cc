#include "core/ident/joint_records.h"

#include <algorithm>
#include <string>
#include <vector>

#include "core/ident/aperiodic_windows.h"
#include "core/ident/line_regression.h"
#include "core/ident/mean_spectra.h"
#include "core/stats/confidence.h"

namespace fatmc {
namespace {

/// Spectra of the band, bin after bin with a row a record: row (bin - first) E + e.
struct StackedSpectra {
  Eigen::MatrixXcd channels;  ///< [Y; U] (indirect) or Y
  Eigen::MatrixXcd known;     ///< references or inputs
  Eigen::MatrixXcd inputs;
};

StackedSpectra stack_spectra(std::span<const Measurement> measurements, const BinBand& band) {
  const Measurement& m = measurements.front();
  const int records = static_cast<int>(measurements.size()), rows = band.count() * records;
  StackedSpectra out{Eigen::MatrixXcd(rows, m.indirect() ? m.n_out() + m.n_in() : m.n_out()),
                     Eigen::MatrixXcd(rows, m.n_in()), Eigen::MatrixXcd(rows, m.n_in())};
  for (int e = 0; e < records; ++e) {
    const Measurement& record = measurements[static_cast<std::size_t>(e)];
    const auto put = [&](const Eigen::MatrixXd& samples, auto&& columns) {
      const Eigen::MatrixXcd spectrum = record_spectrum(samples, band.last + 1);
      for (int b = 0; b < band.count(); ++b) columns.row(b * records + e) = spectrum.row(band.first + b);
    };
    put(record.outputs, out.channels.leftCols(m.n_out()));
    put(record.inputs, out.inputs);
    if (m.indirect()) {
      out.channels.rightCols(m.n_in()) = out.inputs;
      put(record.references, out.known);
    }
  }
  if (!m.indirect()) out.known = out.inputs;
  drop_rounding(out.known);
  return out;
}

Status check_records(std::span<const Measurement> measurements, const JointRecordsOptions& options) {
  const Measurement& first = measurements.front();
  const int records = static_cast<int>(measurements.size());
  if (records <= first.n_in()) {
    return fail("several records are solved together where there are more of them than inputs, " +
                std::to_string(first.n_in() + 1) + " or more; there are " + std::to_string(records));
  }
  for (const Measurement& m : measurements) {
    if (m.inputs.rows() != first.inputs.rows() || m.experiment.rate_hz != first.experiment.rate_hz) {
      return fail("the records differ in length or rate, cut them to one");
    }
    if (m.n_in() != first.n_in() || m.n_out() != first.n_out() || m.indirect() != first.indirect()) {
      return fail("the records differ in their inputs, outputs or references");
    }
  }
  if (options.n_e < 1 || options.order < 0 || options.order > 8 || 2 * options.n_e <= options.order) {
    return fail(Error{"", 0, "n-e",
                      "2 n_E + 1 bins determine no polynomial of degree " + std::to_string(options.order) +
                          " with bins to spare, take n_E >= " + std::to_string(options.order / 2 + 1) +
                          " and an order of 0 ... 8"});
  }
  return {};
}

class JointRegression {
 public:
  JointRegression(const StackedSpectra& spectra, const BinBand& band, int records,
                  const JointRecordsOptions& options)
      : spectra_(spectra),
        band_(band),
        records_(records),
        order_(options.order),
        width_(2 * options.n_e + 1),
        n_(static_cast<int>(spectra.known.cols())),
        q_(width_ * (records - n_)),
        limit_(f_quantile(kMisfitLevel, 2.0 * n_ * (width_ - 1 - options.order), 2.0 * q_)) {
    for (int b = 0; b < band.count(); ++b) {
      bins_.push_back(regress_line(spectra.known.middleRows(b * records, records),
                                   spectra.channels.middleRows(b * records, records), n_));
    }
  }

  [[nodiscard]] int q() const { return q_; }

  /// Covariance of one record's spectrum, from the residuals of the window's bins.
  [[nodiscard]] Eigen::MatrixXcd noise(int bin) const {
    const int first = band_.window(bin, width_) - band_.first;
    Eigen::MatrixXcd sum = bins_[static_cast<std::size_t>(first)].C_Z;
    for (int w = 1; w < width_; ++w) sum += bins_[static_cast<std::size_t>(first + w)].C_Z;
    return sum / width_;
  }

  /// The smoothed regression, or that of the bin alone where smoothing shows; `noise` is its covariance.
  LineRegression line(int bin, const Eigen::MatrixXcd& noise, bool& alone) const {
    if (const LineRegression* silent = first_singular(bin)) return *silent;
    LineRegression out = smoothed(bin);
    const double q_smooth = width_ * records_ - (order_ + 1) * n_;
    alone = !(out.condition < kSingularCondition);
    for (Eigen::Index i = 0; i < noise.rows() && !alone; ++i) {
      const double extra = q_smooth * out.C_Z(i, i).real() - q_ * noise(i, i).real();
      alone = extra / (q_smooth - q_) > limit_ * noise(i, i).real();
    }
    if (alone) out = bins_[static_cast<std::size_t>(bin - band_.first)];
    out.C_Z = noise;
    return out;
  }

 private:
  /// A bin of the window that the records do not determine: its residuals are missing in the noise.
  [[nodiscard]] const LineRegression* first_singular(int bin) const {
    const int first = band_.window(bin, width_) - band_.first;
    for (int w = 0; w < width_; ++w) {
      const LineRegression& at = bins_[static_cast<std::size_t>(first + w)];
      if (!(at.condition < kSingularCondition)) return &at;
    }
    return nullptr;
  }

  [[nodiscard]] LineRegression smoothed(int bin) const {
    const int first = band_.window(bin, width_), largest = std::max(bin - first, first + width_ - 1 - bin);
    const Eigen::Index from = static_cast<Eigen::Index>(first - band_.first) * records_;
    Eigen::MatrixXcd regressor(width_ * records_, (order_ + 1) * n_);
    for (Eigen::Index row = 0; row < regressor.rows(); ++row) {
      const double d = static_cast<double>(first + static_cast<int>(row) / records_ - bin) / largest;
      double power = 1.0;
      for (int s = 0; s <= order_; ++s, power *= d) {  // constant terms last
        regressor.row(row).segment((order_ - s) * n_, n_) = power * spectra_.known.row(from + row);
      }
    }
    return regress_line(regressor, spectra_.channels.middleRows(from, regressor.rows()), n_);
  }

  const StackedSpectra& spectra_;
  BinBand band_;
  int records_, order_, width_, n_, q_;
  double limit_;
  std::vector<LineRegression> bins_;
};

}  // namespace

Result<ResponseEstimate> joint_records(std::span<const Measurement> measurements,
                                       const JointRecordsOptions& options) {
  if (Status status = check_records(measurements, options); !status) return fail(status.error());
  const Measurement& m = measurements.front();
  const int records = static_cast<int>(measurements.size()), width = 2 * options.n_e + 1;
  const Result<BinBand> band = bin_band(m, width);
  if (!band) return fail(band.error());
  ResponseEstimate out;
  FrmEstimate& e = out.frm;
  begin_estimate(m, *band, width, e);
  const StackedSpectra spectra = stack_spectra(measurements, *band);
  const JointRegression regression(spectra, *band, records, options);
  e.q = e.q_noise = regression.q();
  for (int k = 0; k < e.line_count(); ++k) {
    const int bin = e.lines[static_cast<std::size_t>(k)];
    const Eigen::MatrixXcd noise = regression.noise(bin);
    bool alone = false;
    const LineRegression line = regression.line(bin, noise, alone);
    if (alone) out.fallback.push_back(bin);
    const int row = (bin - band->first) * records;
    e.C_Z_noise[k].topLeftCorner(noise.rows(), noise.cols()) = noise;
    store_input_quality(e, k, spectra.inputs.row(row).transpose());
    store_line(e, k, line);
  }
  if (!out.fallback.empty()) {
    out.notes.push_back(std::to_string(out.fallback.size()) + " of " + std::to_string(e.line_count()) +
                        " lines are solved by themselves: over " + std::to_string(width) +
                        " bins the response is no polynomial of degree " + std::to_string(options.order) +
                        " within the noise there");
  }
  return out;
}

}  // namespace fatmc
