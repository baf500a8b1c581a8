#include "coordinator/cli/estimate_conventions.h"

namespace fatmc::cli {
namespace {

using Json = nlohmann::ordered_json;

std::string transient_convention(const EstimatedRecord& e) {
  const std::string place =
      ", between the first excited bin - (periods - 1) and the last + (periods - 1), shifted at the "
      "ends; taken off outputs and inputs, not off references";
  switch (e.method) {
    case EstimationMethod::tlpm:
    case EstimationMethod::robust:
      return "polynomial of degree order through the n_transient nearest non-excited bins on each side, or "
             "where that is "
             "null through the periods + order nearest ones in all" +
             place;
    case EstimationMethod::etfe:
      return "none is removed: skip the periods that are not steady";
    case EstimationMethod::arbitrary:
      return e.records > 1 ? "none is removed: records start and end at rest"
                           : "polynomial of degree order, estimated with the response";
    case EstimationMethod::welch:
      return "none is removed; the mean of each segment is";
    case EstimationMethod::lrm:
      if (!periodic(e))
        return "rational of degree order with the response's denominator, estimated with the response";
      [[fallthrough]];
    case EstimationMethod::lpm:
      break;
  }
  return "polynomial of degree order through the n_transient nearest non-excited bins on each side" + place;
}

std::string window_convention(const EstimatedRecord& e) {
  switch (e.method) {
    case EstimationMethod::tlpm:
    case EstimationMethod::etfe:
      return "each line by itself: as many records as inputs, or one input a line";
    case EstimationMethod::robust:
      return "each line by itself, least squares over records";
    case EstimationMethod::arbitrary:
      return std::string("2 n_e + 1 DFT bins") + (e.records > 1 ? " of all records" : "") +
             ", n_e on each side, shifted at the ends" +
             (e.records > 1 ? "; fallback_lines by themselves" : "");
    case EstimationMethod::welch:
      return "each bin of a segment by itself, least squares over segments";
    case EstimationMethod::lrm:
      if (!periodic(e)) return "2 n_e + 1 DFT bins, n_e on each side, shifted at the ends";
      [[fallthrough]];
    case EstimationMethod::lpm:
      break;
  }
  return "2 n_e + 1 nearest excited lines, n_e on each side, shifted at the ends";
}

std::string variance_convention(EstimationMethod method) {
  if (method == EstimationMethod::lrm) {
    return "E|G - G0|^2 of the element to first order in the noise, from the residuals of the linearised "
           "problem; no exact "
           "law";
  }
  const std::string law = "; |G - G0|^2 / variance ~ F(2, 2q)";
  if (method == EstimationMethod::tlpm || method == EstimationMethod::etfe) {
    return "E|G - G0|^2 of the element from the noise of outputs and inputs, B_jj C_V,ii, over records where "
           "there are "
           "more of them than inputs" +
           law;
  }
  if (method == EstimationMethod::welch)
    return "E|G - G0|^2 of the element, B_jj C_V,ii" + law + " for independent segments";
  return "total variance E|G - G0|^2 of the element, B_jj C_V,ii" + law;
}

std::string bias_convention(EstimationMethod method) {
  switch (method) {
    case EstimationMethod::lpm:
      return "|sum s_i (2 d_i / B_3dB)^E| |G|, E = order + 2 (order + 1 for odd orders), s the constant-term "
             "row of the "
             "least-squares polynomial at the offsets d_i, B_3dB = 2 sqrt((1 - 1/sqrt 2) |g0 / g2|) from the "
             "polynomial through the estimated element over the window, linear term dropped; in windows that "
             "are shifted or "
             "uneven the odd power order + 1 does not cancel and is left out, as in (2.145)";
    case EstimationMethod::tlpm:
    case EstimationMethod::etfe:
      return "of the ratio of noisy spectra, |G| exp(-|U|^2/s_U^2) |1 - rho r| (2.40-2.42, corrected); empty "
             "for several "
             "records";
    default:
      return "empty: the method has no estimate of it";
  }
}

}  // namespace

Json conventions(const EstimatedRecord& e) {
  const bool harmonics = needs_period(e.method) || (e.method == EstimationMethod::lrm && periodic(e));
  std::string line = "DFT bin of the record; frequency_hz = line rate_hz / samples";
  if (harmonics) line = "harmonic of one period; frequency_hz = line rate_hz / period_samples";
  if (e.method == EstimationMethod::welch)
    line = "DFT bin of one segment; frequency_hz = line rate_hz / segment";
  const std::string dft =
      e.method == EstimationMethod::welch
          ? "N^(-1/2) sum w[n] x[n] exp(-j 2 pi m n / N) over a segment, mean square of w = 1"
          : "N^(-1/2) sum x[n] exp(-j 2 pi m n / N) over the whole record, N = periods period_samples";
  Json out = {
      {"line", line}, {"dft", dft}, {"transient", transient_convention(e)}, {"window", window_convention(e)}};
  if (e.method == EstimationMethod::lpm || e.method == EstimationMethod::arbitrary) {
    out["polynomial"] = "of degree order in the true frequency distance";
  }
  if (e.method == EstimationMethod::lrm) {
    out["rational"] =
        "numerator and denominator of degree order in the true frequency distance, denominator 1 at the "
        "line, one denominator a channel; at fallback_lines the polynomial of that degree";
  }
  out["variance"] = variance_convention(e.method);
  out["bias"] = bias_convention(e.method);
  out["confidence"] =
      "radius in standard deviations of an element; univariate: one element, bonferroni: all elements at "
      "once, "
      "simultaneous: every linear combination of elements, joint: vec(E)^H (B kron C_V)^-1 vec(E) <= "
      "radius^2";
  out["noise"] = "standard deviation of the mean spectra of outputs and inputs at the scale of dft";
  out["nonlinear_distortion"] =
      "total over noise variance, of y - G u for outputs and of each channel; ~ F(2q, 2 q_noise) where "
      "there is noise alone, a large interpolation bias raises it, too";
  out["three_db_hz"] =
      "|B_1 - B_2| of (2.142-2.144) by line, output and input, from the polynomial of the bias";
  return out;
}

}  // namespace fatmc::cli
