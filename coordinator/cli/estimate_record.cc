#include "coordinator/cli/estimate_record.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "coordinator/input/record_file.h"
#include "core/base/text.h"
#include "core/ident/fast_lpm.h"
#include "core/ident/interpolation_bias.h"

namespace fatmc::cli {
namespace {

/// V_trim / V_mean (3.4). V_trim is `trim_speed_m_s` of the record's TOML, or else the record's first sample.
Result<double> speed_factor(const Record& record, double first_speed, const std::string& file) {
  const int v = record.column("V");
  if (std::find(record.auxiliary.begin(), record.auxiliary.end(), v) == record.auxiliary.end()) {
    return fail(Error{file, 0, "speed-correction", "needs the airspeed: name the column V among the auxiliary channels"});
  }
  const double trim = record.trim_speed_m_s.value_or(first_speed);
  const double factor = std::abs(trim) / std::abs(record.samples.col(v).mean());
  if (!std::isfinite(factor) || factor <= 0.0) {
    return fail(Error{file, 0, "V", "has no mean speed to correct with"});
  }
  return factor;
}

/// Lines that hold no estimate, as an error; success where there are none.
Status check_lines(const FrmEstimate& frm, const std::string& file) {
  for (int k = 0; k < frm.line_count(); ++k) {
    const LineStatus status = frm.status[static_cast<std::size_t>(k)];
    if (status == LineStatus::ok) continue;
    const std::string what = status == LineStatus::singular_regressor
                                 ? "the excitation channels depend on each other, name independent ones"
                                 : "an input does not follow the references, leave it out";
    return fail(Error{file, 0, "line " + std::to_string(frm.lines[static_cast<std::size_t>(k)]), what});
  }
  return {};
}

}  // namespace

Result<EstimatedRecord> estimate_record(const EstimateOptions& options) {
  const std::string& file = options.record;
  Result<Record> read = read_record(file, options.meta);
  if (!read) return fail(read.error());
  EstimatedRecord out;
  out.record = std::move(*read);
  Record& record = out.record;
  if (Status status = complete_period(record, file); !status) return fail(status.error());
  const int v = record.column("V");
  const double first_speed = v >= 0 ? record.samples(0, v) : 0.0;
  if (Status status = skip_periods(record, options.skip_periods, file); !status) return fail(status.error());

  const bool indirect = !record.reference.empty();
  if (indirect && record.reference.size() != record.input.size()) {
    return fail(Error{file, 0, "reference", std::to_string(record.reference.size()) + " references for " +
                                                std::to_string(record.input.size()) +
                                                " inputs: the indirect estimate needs one a input; leave the "
                                                "references out for a direct one"});
  }
  Result<LpmGrid> grid =
      LpmGrid::create({record.excited_lines, record.period_samples, record.periods, record.rate_hz}, options.lpm,
                      static_cast<int>(record.input.size()));
  if (!grid) {
    Error error = grid.error();
    if (error.file.empty()) error.file = file;
    return fail(error);
  }
  FastLpm lpm(*grid, static_cast<int>(record.output.size()));
  lpm.load(record.channels(record.output), record.channels(record.input));
  out.frm = indirect ? lpm.indirect(spectra_at_lines(*grid, record.channels(record.reference))) : lpm.direct();
  if (Status status = check_lines(out.frm, file); !status) return fail(status.error());
  if (options.speed_correction) {
    const Result<double> factor = speed_factor(record, first_speed, file);
    if (!factor) return fail(factor.error());
    out.speed_factor = *factor;
    scale_response(out.frm, *factor);
  }
  out.bias = interpolation_bias(*grid, out.frm);
  return out;
}

void add_estimate_options(CLI::App& command, EstimateOptions& options) {
  command.add_option("--meta", options.meta, "the record's TOML where it is not beside the CSV");
  command.add_option("--n-e", options.lpm.n_e, "excited lines on each side of a line")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  command.add_option("--order", options.lpm.order, "degree of the polynomials")
      ->check(CLI::Range(0, 10))
      ->capture_default_str();
  command.add_option("--n-transient", options.lpm.n_transient, "non-excited bins on each side of a line")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  command.add_option("--skip-periods", options.skip_periods, "leading periods to leave out")
      ->check(CLI::Range(0, 1000000))
      ->capture_default_str();
  command.add_flag("--speed-correction", options.speed_correction,
                   "scale with V_trim / V_mean; V must be an auxiliary channel");
}

void print_estimate_head(const EstimateOptions& options, const EstimatedRecord& e) {
  const FrmEstimate& frm = e.frm;
  std::printf("%s: %d periods of %d samples at %s Hz, %d excited lines, %s to %s Hz\n",
              options.record.c_str(), e.record.periods, e.record.period_samples,
              shortest(e.record.rate_hz).c_str(), frm.line_count(), significant(frm.frequency_hz.front(), 4).c_str(),
              significant(frm.frequency_hz.back(), 4).c_str());
  std::printf("fast LPM, %s, order %d, n_E %d: q = %d degrees of freedom (noise %d)\n",
              frm.indirect ? "indirect" : "direct", options.lpm.order, options.lpm.n_e, frm.q, frm.q_noise);
  if (options.speed_correction) std::printf("speed correction (3.4): factor %s\n", significant(e.speed_factor, 5).c_str());
}

}  // namespace fatmc::cli
