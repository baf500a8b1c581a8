#include "core/ident/arbitrary_lpm.h"

#include <string>

#include "core/ident/aperiodic_windows.h"
#include "core/ident/line_regression.h"
#include "core/ident/mean_spectra.h"

namespace fatmc {

Result<ResponseEstimate> arbitrary_lpm(const Measurement& m, const ArbitraryLpmOptions& options) {
  const int n = m.n_in(), width = 2 * options.n_e + 1, parameters = (options.order + 1) * (n + 1);
  if (options.n_e < 1 || options.order < 0 || options.order > 8 || width <= parameters) {
    return fail(Error{"", 0, "n-e",
                      "q = 2 n_E + 1 - (R + 1)(n_in + 1) = " + std::to_string(width - parameters) +
                          " leaves no degree of freedom, take n_E >= " +
                          std::to_string((parameters + 1) / 2) + " and an order of 0 ... 8"});
  }
  const Result<BinBand> band = bin_band(m, width);
  if (!band) return fail(band.error());
  ResponseEstimate out;
  FrmEstimate& e = out.frm;
  begin_estimate(m, *band, width, e);
  e.q = width - parameters;

  Eigen::MatrixXcd z(band->last + 1, e.n_out + n);
  z << record_spectrum(m.outputs, band->last + 1), record_spectrum(m.inputs, band->last + 1);
  Eigen::MatrixXcd known = e.indirect ? record_spectrum(m.references, band->last + 1) : z.rightCols(n);
  drop_rounding(known);
  Eigen::MatrixXcd regressor(width, parameters);
  for (int k = 0; k < e.line_count(); ++k) {
    const int bin = e.lines[static_cast<std::size_t>(k)], first = band->window(bin, width);
    const int largest = std::max(bin - first, first + width - 1 - bin);
    for (int w = 0; w < width; ++w) {
      const double d = static_cast<double>(first + w - bin) / largest;
      double power = 1.0;
      for (int s = 0; s <= options.order;
           ++s, power *= d) {  // constant terms last, the transient's before them
        const int column = (options.order - s) * (n + 1);
        regressor(w, column) = power;
        regressor.row(w).segment(column + 1, n) = power * known.row(first + w);
      }
    }
    store_input_quality(e, k, z.row(bin).tail(n).transpose());
    store_line(
        e, k,
        regress_line(regressor, z.middleRows(first, width).leftCols(e.indirect ? e.n_out + n : e.n_out), n));
  }
  return out;
}

}  // namespace fatmc
