#include "coordinator/cli/estimate_report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "coordinator/cli/estimate_quality.h"
#include "core/base/text.h"
#include "core/stats/confidence.h"

namespace fatmc::cli {
namespace {

std::size_t index(int i) { return static_cast<std::size_t>(i); }

bool ok(const FrmEstimate& frm, int k) { return frm.status[index(k)] == LineStatus::ok; }

bool periodic(const EstimatedRecord& e) { return e.record.periods >= 2 && !e.record.excited_lines.empty(); }

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

Json coherence(const EstimatedRecord& e) {
  if (e.response.coherence.count() == 0) return nullptr;
  Json out = Json::array();
  for (int k = 0; k < e.response.frm.line_count(); ++k) {
    Json row = Json::array();
    for (int i = 0; i < e.response.frm.n_out; ++i) row.push_back(e.response.coherence[k](i, 0));
    out.push_back(row);
  }
  return out;
}

/// Whether an element stands out of its own noise: zero lies outside its 95 % disc.
class SignificanceTest {
 public:
  explicit SignificanceTest(const FrmEstimate& frm)
      : frm_(frm), limit_(frm.q > 0 ? f_quantile_2_2q(0.95, frm.q) : 0.0) {}
  [[nodiscard]] bool operator()(int k, int i, int j) const {
    return std::norm(frm_.G[k](i, j)) > limit_ * frm_.variance(k, i, j);
  }

 private:
  const FrmEstimate& frm_;
  double limit_;
};

/// The four largest local maxima of one element's magnitude that stand out of its noise, by frequency.
std::string peaks(const FrmEstimate& frm, const SignificanceTest& significant_at, int i, int j) {
  std::vector<std::pair<double, int>> found;
  const auto magnitude = [&](int k) { return std::abs(frm.G[k](i, j)); };
  for (int k = 1; k + 1 < frm.line_count(); ++k) {
    if (magnitude(k) > magnitude(k - 1) && magnitude(k) > magnitude(k + 1) && significant_at(k, i, j)) {
      found.emplace_back(magnitude(k), k);
    }
  }
  std::sort(found.rbegin(), found.rend());
  found.resize(std::min<std::size_t>(found.size(), 4));
  std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  std::vector<std::string> parts;
  for (const auto& [value, k] : found) {
    parts.push_back(significant(frm.frequency_hz[static_cast<std::size_t>(k)], 4) + " Hz (" +
                    significant(value, 3) + ")");
  }
  return parts.empty() ? "none" : join(parts);
}

/// Where nothing excites, an estimate is noise: its variance says so, and this line to who does not look at variances.
void print_noise_alone(const FrmEstimate& frm, const SignificanceTest& significant_at) {
  int alone = 0, points = 0;
  for (int k = 0; k < frm.line_count(); ++k) {
    for (int j = 0; j < frm.n_in && ok(frm, k); ++j) {
      for (int i = 0; i < frm.n_out && frm.holds(k, j); ++i, ++points)
        alone += significant_at(k, i, j) ? 0 : 1;
    }
  }
  if (10 * alone > points) {
    std::printf(
        "at %d of %d points zero lies within the element's 95 %% disc, noise alone would do: excite more "
        "there, "
        "or restrict the lines (--band)\n",
        alone, points);
  }
}

void print_cautions(const EstimateArguments& arguments, const EstimatedRecord& e) {
  const FrmEstimate& frm = e.response.frm;
  for (const std::string& note : e.response.notes) std::printf("%s\n", note.c_str());
  int biased = 0;
  for (int k = 0; k < frm.line_count() && e.response.bias.count() > 0; ++k) {
    biased += static_cast<int>((e.response.bias[k].array() > 0.1 * frm.G[k].array().abs()).count());
  }
  if (biased > 0 && e.method == EstimationMethod::lpm) {
    const int smallest =  // that leaves a degree of freedom
        ((arguments.estimator.order + 1) * frm.n_in + 1) / 2;
    std::printf(
        "interpolation bias above 10 %% of the element at %d of %d points: a smaller --n-e follows peaks "
        "more "
        "closely, try --n-e %d\n",
        biased, frm.line_count() * frm.n_out * frm.n_in, smallest + 1);
  } else if (biased > 0) {
    std::printf("bias of the ratio above 10 %% of the element at %d points: more periods or a larger input\n",
                biased);
  }
  int outliers = 0;
  for (int k = 0; k < frm.line_count(); ++k) {
    for (int j = 0; j < frm.n_in; ++j) outliers += frm.holds(k, j) ? frm.outlier[k](j, 0) : 0;
  }
  if (outliers > 0)
    std::printf("%d input values lie below 3 sigma of their noise: distrust those lines (5.2.2)\n", outliers);
}

}  // namespace

std::string frm_csv(const EstimatedRecord& e) {
  const FrmEstimate& frm = e.response.frm;
  std::string text = "line,frequency_hz,output,input,re,im,variance,bias\n";
  const auto name = [&](int column) { return e.record.names[index(column)]; };
  for (int k = 0; k < frm.line_count(); ++k) {
    if (!ok(frm, k)) continue;
    const std::string head =
        std::to_string(frm.lines[index(k)]) + "," + shortest(frm.frequency_hz[index(k)]) + ",";
    for (int i = 0; i < frm.n_out; ++i) {
      for (int j = 0; j < frm.n_in; ++j) {
        if (!frm.holds(k, j)) continue;
        const std::complex<double> g = frm.G[k](i, j);
        text += head + name(e.record.output[index(i)]) + "," + name(e.record.input[index(j)]) + "," +
                shortest(g.real()) + "," + shortest(g.imag()) + "," + shortest(frm.variance(k, i, j)) + "," +
                (e.response.bias.count() > 0 ? shortest(e.response.bias[k](i, j)) : "") + "\n";
      }
    }
  }
  return text;
}

std::string estimate_json(const EstimateArguments& arguments, const EstimatedRecord& e) {
  const FrmEstimate& frm = e.response.frm;
  const EstimationMethod method = e.method;
  const bool windowed = method == EstimationMethod::lpm || method == EstimationMethod::arbitrary ||
                        method == EstimationMethod::lrm;
  const bool transient_bins = method == EstimationMethod::lpm || method == EstimationMethod::tlpm ||
                              method == EstimationMethod::robust ||
                              (method == EstimationMethod::lrm && periodic(e));
  const bool matched =
      method == EstimationMethod::tlpm && !arguments.estimator.n_transient && e.record.periods >= 5;
  const bool has_order = method != EstimationMethod::etfe && method != EstimationMethod::welch;
  Json json;
  json["method"] = arguments.method;
  json["indirect"] = frm.indirect;
  json["order"] = has_order ? Json(arguments.estimator.order) : Json();
  json["n_e"] = windowed ? Json(arguments.estimator.n_e_of(method)) : Json();
  json["q"] = frm.q;
  json["n_transient"] =
      transient_bins && !matched ? Json(arguments.estimator.n_transient.value_or(5)) : Json();
  json["q_noise"] = frm.q_noise > 0 ? Json(frm.q_noise) : Json();
  json["records"] = arguments.records.size();
  json["periods"] = e.record.periods > 0 ? Json(e.record.periods) : Json();
  json["skipped_periods"] = arguments.skip_periods;
  json["period_samples"] = e.record.period_samples > 0 ? Json(e.record.period_samples) : Json();
  json["samples"] = e.record.sample_count();
  json["rate_hz"] = e.record.rate_hz;
  std::vector<int> lines, left_out, border;
  for (int k = 0; k < frm.line_count(); ++k) {
    (ok(frm, k) ? lines : left_out).push_back(frm.lines[index(k)]);
    if (frm.border[index(k)] != 0) border.push_back(frm.lines[index(k)]);
  }
  json["lines"] = lines;
  json["speed_factor"] = arguments.speed_correction ? Json(e.speed_factor) : Json();
  json["border_lines"] = border;
  json["lines_without_estimate"] = left_out;
  json["fallback_lines"] = e.response.fallback;
  json["regressor_condition"] = frm.regressor_condition;
  json["input_condition"] = frm.indirect ? Json(frm.input_condition) : Json();
  json["confidence"] = confidence_json(e);
  add_quality(json, e);
  json["bias_variants"] = arguments.bias_variants ? bias_variants_json(e) : Json();
  json["coherence"] = coherence(e);
  json["notes"] = e.response.notes;
  json["conventions"] = conventions(e);
  return json.dump(2) + "\n";
}

void print_summary(const EstimateArguments& arguments, const EstimatedRecord& e) {
  const FrmEstimate& frm = e.response.frm;
  print_estimate_head(arguments, e);
  print_quality(e);
  const SignificanceTest significant_at(frm);
  for (int i = 0; i < frm.n_out; ++i) {
    for (int j = 0; j < frm.n_in; ++j) {
      std::printf("  %s/%s: highest peaks %s\n", e.record.names[index(e.record.output[index(i)])].c_str(),
                  e.record.names[index(e.record.input[index(j)])].c_str(),
                  peaks(frm, significant_at, i, j).c_str());
    }
  }
  print_noise_alone(frm, significant_at);
  print_cautions(arguments, e);
  std::printf("written: %s/frm.csv, %s/estimate.json\n", arguments.directory.c_str(),
              arguments.directory.c_str());
}

}  // namespace fatmc::cli
