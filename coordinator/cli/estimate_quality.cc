#include "coordinator/cli/estimate_quality.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>

#include "core/base/text.h"
#include "core/ident/interpolation_bias.h"
#include "core/ident/nonlinear_distortion.h"
#include "core/stats/confidence_regions.h"

namespace fatmc::cli {
namespace {

constexpr std::array<double, 4> kLevels = {0.75, 0.90, 0.95, 0.99};
constexpr double kGaussianSnrDb = 20.0;  // (2.168), outliers being watched
constexpr double kDistortionLevel = 0.01;

std::size_t index(int i) { return static_cast<std::size_t>(i); }

bool zippered(const FrmEstimate& frm) { return frm.estimated.count() > 0; }

bool has_noise(const FrmEstimate& frm) { return frm.q_noise > 0; }

/// Methods whose C_Z stands apart from the noise and follows its law.
bool has_distortion(const EstimatedRecord& e) {
  return (e.method == EstimationMethod::lpm || e.method == EstimationMethod::robust) &&
         has_noise(e.response.frm);
}

/// (|U^| - s)/s in dB (5.10); null where there is no noise, or more noise than signal.
std::optional<double> snr_db(const FrmEstimate& frm, int k, int j) {
  const double snr = frm.input_snr[k](j, 0);
  if (!std::isfinite(snr) || !(snr > 0.0)) return std::nullopt;
  return 20.0 * std::log10(snr);
}

bool low_snr(const FrmEstimate& frm, int k, int j) {
  return frm.holds(k, j) && 20.0 * std::log10(std::max(frm.input_snr[k](j, 0), 1e-300)) < kGaussianSnrDb;
}

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(); }

/// [line][row] of a stack of columns.
Json columns(const MatrixStack<double>& stack) {
  Json out = Json::array();
  for (int k = 0; k < stack.count(); ++k) {
    Json row = Json::array();
    for (int i = 0; i < stack.rows(); ++i) row.push_back(number(stack[k](i, 0)));
    out.push_back(row);
  }
  return out;
}

/// [line][output][input]
Json matrices(const MatrixStack<double>& stack) {
  Json out = Json::array();
  for (int k = 0; k < stack.count(); ++k) {
    Json rows = Json::array();
    for (int i = 0; i < stack.rows(); ++i) {
      Json row = Json::array();
      for (int j = 0; j < stack.cols(); ++j) row.push_back(number(stack[k](i, j)));
      rows.push_back(row);
    }
    out.push_back(rows);
  }
  return out;
}

std::vector<std::string> channel_names(const EstimatedRecord& e) {
  std::vector<std::string> names;
  for (const auto* columns : {&e.record.output, &e.record.input}) {
    for (const int c : *columns) names.push_back(e.record.names[index(c)]);
  }
  return names;
}

Json noise_json(const EstimatedRecord& e) {
  const FrmEstimate& frm = e.response.frm;
  if (!has_noise(frm)) return nullptr;
  const int n = frm.n_out + frm.n_in;
  Json deviation = Json::array();
  for (int k = 0; k < frm.line_count(); ++k) {
    Json row = Json::array();
    for (int i = 0; i < n; ++i) row.push_back(std::sqrt(std::max(0.0, frm.C_Z_noise[k](i, i).real())));
    deviation.push_back(row);
  }
  // Outputs and inputs are vectors of their own in (A.14, A.15): dimension n, one column.
  Json radii = Json::array();
  for (const double level : kLevels) {
    Json row = {{"level", level},
                {"univariate", *region_radius(RegionKind::univariate, level, 1, 1, frm.q_noise)}};
    const auto shadow = [&](int dimension) {
      const auto radius = region_radius(RegionKind::simultaneous, level, dimension, 1, frm.q_noise);
      return radius ? Json(*radius) : Json();
    };
    row["outputs_simultaneous"] = shadow(frm.n_out);
    row["inputs_simultaneous"] = shadow(frm.n_in);
    radii.push_back(row);
  }
  return {{"q", frm.q_noise},
          {"channels", channel_names(e)},
          {"deviation", deviation},
          {"radius_over_deviation", radii}};
}

Json distortion_json(const EstimatedRecord& e) {
  if (!has_distortion(e)) return nullptr;
  const FrmEstimate& frm = e.response.frm;
  const NonlinearDistortion d = nonlinear_distortion(frm, kDistortionLevel);
  std::vector<std::string> names = channel_names(e);
  names.resize(index(d.channel_ratio.rows()));
  return {{"level", d.level},
          {"limit", d.limit},
          {"degrees_of_freedom", {2 * frm.q, 2 * frm.q_noise}},
          {"outputs_above", d.above},
          {"expected_above", d.level * frm.line_count()},
          {"output_ratio", columns(d.output_ratio)},
          {"channels", names},
          {"channel_ratio", columns(d.channel_ratio)}};
}

Json widths_json(const EstimatedRecord& e) {
  if (!e.response.grid) return nullptr;
  const LpmGrid& grid = *e.response.grid;
  return {{"linear_dropped", matrices(three_db_range_hz(grid, e.response.frm, ThreeDbRule::linear_dropped))},
          {"linear_kept", matrices(three_db_range_hz(grid, e.response.frm, ThreeDbRule::linear_kept))}};
}

void print_snr(const EstimatedRecord& e) {
  const FrmEstimate& frm = e.response.frm;
  for (int j = 0; j < frm.n_in; ++j) {
    std::vector<std::pair<double, int>> values;
    int low = 0;
    for (int k = 0; k < frm.line_count(); ++k) {
      if (low_snr(frm, k, j)) ++low;
      if (const auto db = snr_db(frm, k, j); db && frm.holds(k, j)) values.emplace_back(*db, k);
    }
    if (values.empty()) continue;
    std::sort(values.begin(), values.end());
    std::printf("  input SNR of %s (5.10): smallest %s dB at %s Hz, median %s dB\n",
                e.record.names[index(e.record.input[index(j)])].c_str(),
                fixed(values.front().first, 1).c_str(),
                significant(frm.frequency_hz[index(values.front().second)], 4).c_str(),
                fixed(values[values.size() / 2].first, 1).c_str());
    if (low > 0) {
      std::printf(
          "    below %g dB on %d lines: the normal law behind variances and regions does not hold there "
          "(2.168); excite "
          "more, record more periods, or leave those lines out\n",
          kGaussianSnrDb, low);
    }
  }
}

void print_distortion(const EstimatedRecord& e) {
  const FrmEstimate& frm = e.response.frm;
  const NonlinearDistortion d = nonlinear_distortion(frm, kDistortionLevel);
  std::vector<std::string> parts;
  for (int i = 0; i < frm.n_out; ++i) {
    parts.push_back(e.record.names[index(e.record.output[index(i)])] + " " +
                    significant(d.median_output_ratio(i), 3) + " (" + std::to_string(d.above[index(i)]) +
                    " above)");
  }
  std::printf(
      "  total over noise variance, median (2.153): %s; F test at 1 %%: limit %s, %s of %d lines expected "
      "above\n",
      join(parts).c_str(), significant(d.limit, 3).c_str(),
      significant(kDistortionLevel * frm.line_count(), 2).c_str(), frm.line_count());
}

}  // namespace

Json confidence_json(const EstimatedRecord& e) {
  const FrmEstimate& frm = e.response.frm;
  if (e.method == EstimationMethod::lrm || frm.q < 1) return nullptr;
  const int columns = zippered(frm) ? 1 : frm.n_in;
  Json out = Json::array();
  for (const double level : kLevels) {
    const auto ellipsoid = region_radius(RegionKind::joint, level, frm.n_out, columns, frm.q);
    for (const RegionKind kind : kRegionKinds) {
      const bool single = kind == RegionKind::univariate || kind == RegionKind::bonferroni;
      const auto radius = single ? region_radius(kind, level, frm.n_out, columns, frm.q) : ellipsoid;
      out.push_back({{"level", level}, {"kind", name_of(kind)}, {"radius", radius ? Json(*radius) : Json()}});
    }
  }
  return out;
}

void add_quality(Json& json, const EstimatedRecord& e) {
  const FrmEstimate& frm = e.response.frm;
  Json snr = nullptr;
  std::vector<int> low;
  if (has_noise(frm)) {
    snr = Json::array();
    for (int k = 0; k < frm.line_count(); ++k) {
      Json row = Json::array();
      bool any = false;
      for (int j = 0; j < frm.n_in; ++j) {
        const auto db = snr_db(frm, k, j);
        row.push_back(db && frm.holds(k, j) ? Json(*db) : Json());
        any = any || low_snr(frm, k, j);
      }
      snr.push_back(row);
      if (any) low.push_back(frm.lines[index(k)]);
    }
  }
  json["input_snr_db"] = snr;
  json["low_snr_lines"] = low;
  json["noise"] = noise_json(e);
  json["nonlinear_distortion"] = distortion_json(e);
  json["three_db_hz"] = widths_json(e);
}

Json bias_variants_json(const EstimatedRecord& e) {
  if (!e.response.grid) return nullptr;
  const LpmGrid& grid = *e.response.grid;
  Json out;
  for (const auto& [name, constant] :
       {std::pair{"exact_offsets", BiasConstant::exact_offsets}, std::pair{"limit", BiasConstant::limit},
        std::pair{"printed", BiasConstant::printed}}) {
    if (constant == BiasConstant::printed && !printed_bias_constant(grid.options().order)) {
      out[name] = nullptr;
      continue;
    }
    Json alpha = Json::array();
    for (int k = 0; k < grid.line_count(); ++k) alpha.push_back(bias_constant(grid, k, constant));
    MatrixStack<double> bias = interpolation_bias(grid, e.response.frm, constant);
    out[name] = {{"constant", alpha}, {"bias", matrices(bias)}};
  }
  return out;
}

void print_quality(const EstimatedRecord& e) {
  const FrmEstimate& frm = e.response.frm;
  const auto borders = std::count(frm.border.begin(), frm.border.end(), 1);
  double condition = 0.0;
  for (const double value : frm.regressor_condition) {
    if (std::isfinite(value)) condition = std::max(condition, value);
  }
  std::printf("  largest condition of a line's regressor %s; ", significant(condition, 3).c_str());
  if (borders > 0) {
    std::printf("%td border lines, whose windows are not centred\n", borders);
  } else {
    std::printf("no border lines\n");
  }
  if (e.method != EstimationMethod::lrm && frm.q >= 1) {
    const int columns = zippered(frm) ? 1 : frm.n_in;
    const auto radius = [&](RegionKind kind) {
      const auto r = region_radius(kind, 0.95, frm.n_out, columns, frm.q);
      return r ? significant(*r, 3) : std::string("none (q < outputs)");
    };
    std::printf(
        "  95 %% radii in standard deviations: one element %s, all elements (Bonferroni) %s, joint %s\n",
        radius(RegionKind::univariate).c_str(), radius(RegionKind::bonferroni).c_str(),
        radius(RegionKind::joint).c_str());
  }
  if (has_noise(frm)) print_snr(e);
  if (has_distortion(e)) print_distortion(e);
}

}  // namespace fatmc::cli
