#include "core/ident/estimators.h"

#include <array>
#include <utility>

#include "core/base/check.h"
#include "core/ident/arbitrary_lpm.h"
#include "core/ident/fast_lpm.h"
#include "core/ident/interpolation_bias.h"
#include "core/ident/joint_records.h"
#include "core/ident/line_averages.h"
#include "core/ident/local_rational.h"

namespace fatmc {
namespace {

constexpr std::array<std::pair<EstimationMethod, std::string_view>, 7> kNames = {{
    {EstimationMethod::lpm, "lpm"},
    {EstimationMethod::tlpm, "tlpm"},
    {EstimationMethod::etfe, "etfe"},
    {EstimationMethod::lrm, "lrm"},
    {EstimationMethod::arbitrary, "arbitrary"},
    {EstimationMethod::robust, "robust"},
    {EstimationMethod::welch, "welch"},
}};

Result<ResponseEstimate> fast_lpm(const Measurement& m, const EstimatorOptions& options) {
  const LpmOptions lpm_options{options.n_e_of(EstimationMethod::lpm), options.order, options.n_transient.value_or(5)};
  Result<LpmGrid> grid = LpmGrid::create(m.experiment, lpm_options, m.n_in());
  if (!grid) return fail(grid.error());
  FastLpm lpm(*grid, m.n_out());
  lpm.load(m.outputs, m.inputs);
  ResponseEstimate out;
  out.frm = m.indirect() ? lpm.indirect(spectra_at_lines(*grid, m.references)) : lpm.direct();
  out.bias = interpolation_bias(*grid, out.frm);
  out.grid = std::move(*grid);
  return out;
}

Result<ResponseEstimate> line_averages(LineAverage average, std::span<const Measurement> measurements,
                                       const EstimatorOptions& options, std::optional<int> n_transient) {
  return estimate_by_line_averages(measurements, {average, options.order, n_transient});
}

Status check_count(EstimationMethod method, std::span<const Measurement> measurements) {
  const auto count = static_cast<int>(measurements.size());
  const int n_in = measurements.front().n_in();
  if (method == EstimationMethod::robust) {
    if (count > n_in) return {};
    return fail("the robust method needs more records than inputs, " + std::to_string(n_in + 1) + " or more; there " +
                (count == 1 ? "is 1" : "are " + std::to_string(count)));
  }
  if (count == 1 || method == EstimationMethod::tlpm || method == EstimationMethod::etfe ||
      method == EstimationMethod::arbitrary) {
    return {};
  }
  return fail("method " + std::string(name_of(method)) + " takes one record, " + std::to_string(count) +
              " are named; several go with robust, tlpm, etfe or arbitrary");
}

}  // namespace

std::optional<EstimationMethod> estimation_method(std::string_view name) {
  for (const auto& [method, known] : kNames) {
    if (known == name) return method;
  }
  return std::nullopt;
}

std::string_view name_of(EstimationMethod method) {
  for (const auto& [known, name] : kNames) {
    if (known == method) return name;
  }
  return "";
}

std::string estimation_method_names() {
  std::string out;
  for (const auto& [method, name] : kNames) out += (out.empty() ? "" : ", ") + std::string(name);
  return out;
}

bool needs_period(EstimationMethod method) {
  return method != EstimationMethod::lrm && method != EstimationMethod::arbitrary && method != EstimationMethod::welch;
}

int EstimatorOptions::n_e_of(EstimationMethod method) const {
  return n_e.value_or(method == EstimationMethod::lrm ? 6 : 9);
}

Result<ResponseEstimate> estimate_response(EstimationMethod method, std::span<const Measurement> measurements,
                                           const EstimatorOptions& options) {
  FATMC_CHECK(!measurements.empty(), "a measurement");
  if (Status status = check_count(method, measurements); !status) return fail(status.error());
  const Measurement& first = measurements.front();
  const int n_e = options.n_e_of(method);
  switch (method) {
    case EstimationMethod::lpm: return fast_lpm(first, options);
    case EstimationMethod::tlpm:
      return line_averages(LineAverage::transient, measurements, options, options.n_transient);
    case EstimationMethod::etfe: return line_averages(LineAverage::periods, measurements, options, std::nullopt);
    case EstimationMethod::robust:
      return line_averages(LineAverage::transient, measurements, options, options.n_transient.value_or(5));
    case EstimationMethod::lrm:
      return local_rational(first, {.n_e = n_e,
                                    .order = options.order,
                                    .n_transient = options.n_transient.value_or(5),
                                    .threads = options.threads});
    case EstimationMethod::arbitrary:
      return measurements.size() > 1 ? joint_records(measurements, {n_e, options.order})
                                     : arbitrary_lpm(first, {n_e, options.order});
    case EstimationMethod::welch: return welch(first, options.welch);
  }
  return fail("no such method");
}

}  // namespace fatmc
