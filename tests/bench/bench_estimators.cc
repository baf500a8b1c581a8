// Time a line of the estimators beside the fast LPM. Each reports its figure as a counter of its own name, in
// µs a line: spectra, transient, regressions and covariances of a whole call, divided by the lines that it
// estimates.
//
// 3 outputs; etfe and tlpm have 1 input, 8 periods of 2048 samples and 256 lines; robust 3 inputs, 6 records
// of 2 such periods; lrm, arbitrary and welch 3 inputs (lrm 1) in one white record of 8192 samples; joint 3
// inputs in 6 of these.
#include <benchmark/benchmark.h>

#include <span>

#include "core/ident/estimators.h"
#include "core/random/random_stream.h"
#include "core/signal/multisine.h"

namespace fatmc {
namespace {

constexpr int kPeriod = 2048, kOutputs = 3;

Measurement record(int inputs, int periods, bool periodic, std::uint64_t seed) {
  RandomStream stream({seed, 0, 0, 0}, "bench");
  const int samples = periods * kPeriod;
  Measurement m;
  m.experiment.rate_hz = 50.0;
  m.inputs.resize(samples, inputs);
  if (periodic) {
    for (int k = 0; k < 256; ++k) m.experiment.lines.push_back(20 + 3 * k);
    m.experiment.period_samples = kPeriod;
    m.experiment.periods = periods;
  }
  for (int j = 0; j < inputs; ++j) {
    const std::vector<double> x =
        periodic ? Multisine::random_phase(kPeriod, m.experiment.lines, 1.0, stream).samples(periods)
                 : std::vector<double>();
    for (int n = 0; n < samples; ++n)
      m.inputs(n, j) = periodic ? x[static_cast<std::size_t>(n)] : stream.normal();
  }
  m.outputs.resize(samples, kOutputs);
  for (int i = 0; i < kOutputs; ++i) {
    for (int n = 0; n < samples; ++n) {
      m.outputs(n, i) = m.inputs.row(n).sum() * (1.0 + i) + 0.5 * (n > 0 ? m.outputs(n - 1, i) : 0.0) +
                        0.01 * stream.normal();
    }
  }
  return m;
}

void estimator(benchmark::State& state, const char* name, EstimationMethod method, int records, int inputs,
               int periods, bool periodic) {
  std::vector<Measurement> set;
  for (int e = 0; e < records; ++e)
    set.push_back(record(inputs, periods, periodic, static_cast<std::uint64_t>(e)));
  int lines = 0;
  for (auto _ : state) {
    const Result<ResponseEstimate> estimate = estimate_response(method, set, {});
    if (!estimate) return state.SkipWithError(estimate.error().text().c_str());
    lines = estimate->frm.line_count();
    benchmark::DoNotOptimize(estimate->frm.G.data(0));
  }
  state.counters[name] = benchmark::Counter(1e-6 * static_cast<double>(state.iterations()) * lines,
                                            benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

#define FATMC_ESTIMATOR(name, method, ...)                                         \
  BENCHMARK_CAPTURE(estimator, name, #name, EstimationMethod::method, __VA_ARGS__) \
      ->Name(#name)                                                                \
      ->Unit(benchmark::kMillisecond)
FATMC_ESTIMATOR(etfe_line_us, etfe, 1, 1, 8, true);
FATMC_ESTIMATOR(tlpm_line_us, tlpm, 1, 1, 8, true);
FATMC_ESTIMATOR(robust_line_us, robust, 6, 3, 2, true);
FATMC_ESTIMATOR(lrm_line_us, lrm, 1, 1, 4, false);
FATMC_ESTIMATOR(arbitrary_line_us, arbitrary, 1, 3, 4, false);
FATMC_ESTIMATOR(joint_line_us, arbitrary, 6, 3, 4, false);
FATMC_ESTIMATOR(welch_line_us, welch, 1, 3, 4, false);

}  // namespace
}  // namespace fatmc

BENCHMARK_MAIN();
