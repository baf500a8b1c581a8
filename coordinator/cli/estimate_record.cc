#include "coordinator/cli/estimate_record.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "coordinator/input/record_file.h"
#include "core/base/text.h"

namespace fatmc::cli {
namespace {

/// V_trim / V_mean (3.4). V_trim is `trim_speed_m_s` of the record's TOML, or else the record's first sample.
Result<double> speed_factor(const Record& record, double first_speed, const std::string& file) {
  const int v = record.column("V");
  if (std::find(record.auxiliary.begin(), record.auxiliary.end(), v) == record.auxiliary.end()) {
    return fail(Error{file, 0, "speed-correction",
                      "needs the airspeed: name the column V among the auxiliary channels"});
  }
  const double trim = record.trim_speed_m_s.value_or(first_speed);
  const double factor = std::abs(trim) / std::abs(record.samples.col(v).mean());
  if (!std::isfinite(factor) || factor <= 0.0) {
    return fail(Error{file, 0, "V", "has no mean speed to correct with"});
  }
  return factor;
}

/// A record ready for the method: period and lines known where it needs them, leading periods skipped.
Result<Record> prepare_record(const EstimateOptions& options, EstimationMethod method,
                              const std::string& file, double* first_speed) {
  Result<Record> read = read_record(file, options.meta);
  if (!read) return fail(read.error());
  Record& record = *read;
  if (Status status = complete_period(record, file); !status) {
    if (needs_period(method)) return fail(status.error());
    if (options.skip_periods != 0) {
      return fail(
          Error{file, 0, "skip-periods", "the record has no periods to skip: " + status.error().message});
    }
    if (record.periods != 1) {  // one period that the record names still says which lines are excited
      record.periods = record.period_samples = 0;
      record.excited_lines.clear();
    }
  }
  const int v = record.column("V");
  *first_speed = v >= 0 ? record.samples(0, v) : 0.0;
  if (Status status = skip_periods(record, options.skip_periods, file); !status) return fail(status.error());
  if (!record.reference.empty() && record.reference.size() != record.input.size()) {
    return fail(Error{file, 0, "reference",
                      std::to_string(record.reference.size()) + " references for " +
                          std::to_string(record.input.size()) +
                          " inputs: the indirect estimate needs one a input; leave the "
                          "references out for a direct one"});
  }
  return read;
}

Measurement measurement_of(const Record& record, const std::vector<double>& band_hz) {
  Measurement out = {{record.excited_lines, record.period_samples, record.periods, record.rate_hz},
          record.channels(record.output),
          record.channels(record.input),
          record.channels(record.reference)};
  if (!band_hz.empty()) {
    out.low_hz = band_hz[0];
    out.high_hz = band_hz[1];
  }
  return out;
}

Status check_band(const EstimateOptions& options, EstimationMethod method) {
  const std::vector<double>& band = options.band_hz;
  if (band.empty()) return {};
  if (needs_period(method)) {
    return fail(Error{"", 0, "--band", "goes with methods that take any bin (arbitrary, lrm, welch); " + std::string(name_of(method)) +
                                           " takes the excited lines"});
  }
  if (!(band[0] >= 0.0) || !(band[1] > band[0])) return fail(Error{"", 0, "--band", "is two frequencies in Hz that ascend"});
  return {};
}

std::string method_title(EstimationMethod method) {
  switch (method) {
    case EstimationMethod::lpm:
      return "fast LPM";
    case EstimationMethod::tlpm:
      return "transient LPM";
    case EstimationMethod::etfe:
      return "ETFE";
    case EstimationMethod::lrm:
      return "local rational method";
    case EstimationMethod::arbitrary:
      return "LPM for arbitrary excitation";
    case EstimationMethod::robust:
      return "robust method";
    case EstimationMethod::welch:
      return "Welch";
  }
  return "";
}

/// Why the excitation channels do not span all directions, and what to do about it.
std::string dependence(const Record& record, bool indirect) {
  const std::vector<int>& channels = indirect ? record.reference : record.input;
  Eigen::MatrixXd x = record.channels(channels);
  x.rowwise() -= x.colwise().mean().eval();
  for (Eigen::Index i = 0; i < x.cols(); ++i) {
    for (Eigen::Index j = 0; j < i; ++j) {
      if (std::abs(x.col(i).dot(x.col(j))) > 0.999 * x.col(i).norm() * x.col(j).norm()) {
        const auto name = [&](Eigen::Index c) {
          return record.names[static_cast<std::size_t>(channels[static_cast<std::size_t>(c)])];
        };
        return name(j) + " and " + name(i) +
               " carry the same signal, so that their effects cannot be told apart: give each input phases "
               "of its own, "
               "or leave one out";
      }
    }
  }
  return "the excitation channels depend on each other within its window: give each input phases of its own, "
         "or take "
         "a larger --n-e";
}

/// Periodic methods stand or fall with all their lines; the others leave out lines that nothing excites.
Status check_lines(const EstimatedRecord& e, const std::string& file) {
  const FrmEstimate& frm = e.response.frm;
  const bool some = std::find(frm.status.begin(), frm.status.end(), LineStatus::ok) != frm.status.end();
  for (int k = 0; k < frm.line_count(); ++k) {
    const LineStatus status = frm.status[static_cast<std::size_t>(k)];
    if (status == LineStatus::ok || (some && !needs_period(e.method))) continue;
    const std::string what = status == LineStatus::singular_regressor
                                 ? dependence(e.record, frm.indirect)
                                 : "an input does not follow the references, leave it out";
    return fail(Error{file, 0, "line " + std::to_string(frm.lines[static_cast<std::size_t>(k)]), what});
  }
  return {};
}

}  // namespace

Result<EstimatedRecord> estimate_records(const EstimateOptions& options, EstimationMethod method) {
  const std::string& file = options.records.front();
  if (Status status = check_band(options, method); !status) return fail(status.error());
  EstimatedRecord out;
  out.method = method;
  std::vector<Measurement> measurements;
  double first_speed = 0.0;
  for (const std::string& path : options.records) {
    double speed = 0.0;
    Result<Record> record = prepare_record(options, method, path, &speed);
    if (!record) return fail(record.error());
    measurements.push_back(measurement_of(*record, options.band_hz));
    if (path != options.records.front()) continue;
    out.record = std::move(*record);
    first_speed = speed;
  }
  Result<ResponseEstimate> response = estimate_response(method, measurements, options.estimator);
  if (!response) {
    Error error = response.error();
    if (error.file.empty()) error.file = file;
    return fail(error);
  }
  out.records = static_cast<int>(options.records.size());
  out.response = std::move(*response);
  if (Status status = check_lines(out, file); !status) return fail(status.error());
  if (options.speed_correction) {
    const Result<double> factor = speed_factor(out.record, first_speed, file);
    if (!factor) return fail(factor.error());
    out.speed_factor = *factor;
    scale_response(out.response.frm, *factor);
    for (int k = 0; k < out.response.bias.count(); ++k) out.response.bias[k] *= *factor;
  }
  return out;
}

void add_estimate_options(CLI::App& command, EstimateOptions& options) {
  command.add_option("--meta", options.meta, "the records' TOML where it is not beside the CSV");
  command
      .add_option("--n-e", options.estimator.n_e,
                  "lines (bins) on each side of a line: 9, which leaves q = 10 for three inputs and order 2; "
                  "lrm 6, more "
                  "would reach past a lightly damped mode")
      ->check(CLI::Range(1, 100000));
  command
      .add_option(
          "--order", options.estimator.order,
          "degree of the polynomials: odd ones gain nothing in a centred window, 4 needs twice the lines")
      ->check(CLI::Range(0, 10))
      ->capture_default_str();
  command
      .add_option(
          "--n-transient", options.estimator.n_transient,
          "non-excited bins on each side of a line: 5, which leaves 7 degrees of freedom of the noise for "
          "order "
          "2; tlpm with 5 periods and more: (periods + order)/2, for q = periods - 1 as the ETFE has it")
      ->check(CLI::Range(1, 100000));
  command
      .add_option("--skip-periods", options.skip_periods,
                  "leading periods to leave out: none, since transients are estimated; etfe and welch need a "
                  "steady state")
      ->check(CLI::Range(0, 1000000))
      ->capture_default_str();
  command.add_option("--band", options.band_hz, "LOW HIGH in Hz, for methods that take any bin: arbitrary, lrm, welch")
      ->expected(2);
  command.add_flag("--speed-correction", options.speed_correction,
                   "scale with V_trim / V_mean; V must be an auxiliary channel");
}

std::vector<std::string> channel_names(const Record& record, const std::vector<int>& columns) {
  std::vector<std::string> out;
  for (const int c : columns) out.push_back(record.names[static_cast<std::size_t>(c)]);
  return out;
}

std::string estimate_title(const EstimatedRecord& e) {
  const bool joint = e.method == EstimationMethod::arbitrary && e.records > 1;
  return method_title(e.method) + (joint ? ", " + std::to_string(e.records) + " records together" : "") +
         (e.response.frm.indirect ? ", indirect" : ", direct");
}

void print_estimate_head(const EstimateOptions& options, const EstimatedRecord& e) {
  const FrmEstimate& frm = e.response.frm;
  if (e.record.periods > 0) {
    std::printf("%s: %d periods of %d samples at %s Hz, ", options.records.front().c_str(), e.record.periods,
                e.record.period_samples, shortest(e.record.rate_hz).c_str());
  } else {
    std::printf("%s: %d samples at %s Hz, ", options.records.front().c_str(), e.record.sample_count(),
                shortest(e.record.rate_hz).c_str());
  }
  std::printf("%d %slines, %s to %s Hz\n", frm.line_count(), e.record.periods > 0 ? "excited " : "",
              significant(frm.frequency_hz.front(), 4).c_str(),
              significant(frm.frequency_hz.back(), 4).c_str());
  std::printf("%s", estimate_title(e).c_str());
  if (e.method == EstimationMethod::lpm || e.method == EstimationMethod::arbitrary || e.method == EstimationMethod::lrm) {
    std::printf(", order %d, n_E %d", options.estimator.order, options.estimator.n_e_of(e.method));
  }
  std::printf(": q = %d degrees of freedom", frm.q);
  if (frm.q_noise > 0) std::printf(" (noise %d)", frm.q_noise);
  std::printf("\n");
  if (options.speed_correction)
    std::printf("speed correction (3.4): factor %s\n", significant(e.speed_factor, 5).c_str());
}

}  // namespace fatmc::cli
