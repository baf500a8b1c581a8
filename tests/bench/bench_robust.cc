// Speed of the structured singular value, both bounds, on 3 × 3 plants; SLICOT's AB13MD (upper bound alone) beside it.
//
// Counters carry the figures: ssv_us_cold (a plant that nothing is known of), ssv_us_warm (the next of 73 lines along
// frequency), ssv_us_slicot, and met_percent, the share of plants on which the bounds meet.
#include <benchmark/benchmark.h>

#include <vector>

#include "core/robust/loop_matrix.h"
#include "core/robust/structured_singular_value.h"
#include "tests/unit/robust/random_plant.h"
#ifdef FATMC_HAS_SLICOT
#include "tests/support/slicot.h"
#endif

namespace fatmc {
namespace {

constexpr int kPlants = 1000;
constexpr int kLines = 73;

std::vector<test::UncertainLoop> plants(bool feedback) {
  std::vector<test::UncertainLoop> out;
  for (int k = 0; k < kPlants; ++k) {
    RandomStream stream({11, 0, 0, static_cast<std::uint64_t>(k)}, "plant");
    out.push_back(feedback ? test::random_feedback_loop(3, stream) : test::random_loop(3, 3, stream));
  }
  return out;
}

void report(benchmark::State& state, const char* name, int problems) {
  state.counters[name] = benchmark::Counter(static_cast<double>(problems) * 1e-6,
                                            benchmark::Counter::kIsIterationInvariantRate |
                                                benchmark::Counter::kInvert);
}

void cold(benchmark::State& state, const char* name, bool feedback) {
  const std::vector<test::UncertainLoop> all = plants(feedback);
  int met = 0;
  for (auto _ : state) {
    met = 0;
    for (const test::UncertainLoop& loop : all) {
      met += structured_singular_value(loop.x, loop.radii).certified() ? 1 : 0;
    }
    benchmark::DoNotOptimize(met);
  }
  report(state, name, kPlants);
  state.counters["met_percent"] = 100.0 * met / kPlants;
}

// Seventy-three lines between two loops of feedback, the scalings handed from line to line.
void warm(benchmark::State& state) {
  RandomStream stream({11, 0, 0, 5}, "plant");
  const test::UncertainLoop first = test::random_feedback_loop(3, stream), last = test::random_feedback_loop(3, stream);
  std::vector<test::UncertainLoop> lines;
  for (int k = 0; k < kLines; ++k) {
    const double f = static_cast<double>(k) / kLines;
    lines.push_back({(1.0 - f) * first.x + f * last.x, (1.0 - f) * first.radii + f * last.radii});
  }
  for (auto _ : state) {
    SsvScaling scaling;
    double sum = 0.0;
    for (const test::UncertainLoop& line : lines) {
      sum += structured_singular_value(line.x, line.radii, {}, &scaling).upper;
    }
    benchmark::DoNotOptimize(sum);
  }
  report(state, "ssv_us_warm", kLines);
}

BENCHMARK_CAPTURE(cold, feedback_loops, "ssv_us_cold", true)->Name("ssv_us_cold")->Unit(benchmark::kMicrosecond);
BENCHMARK(warm)->Name("ssv_us_warm")->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(cold, random_loops, "ssv_us_cold_random", false)
    ->Name("ssv_us_cold_random")
    ->Unit(benchmark::kMicrosecond);

#ifdef FATMC_HAS_SLICOT
void slicot(benchmark::State& state) {
  const std::vector<test::UncertainLoop> all = plants(true);
  constexpr int kSome = 20;
  std::vector<Eigen::MatrixXcd> matrices;
  for (std::size_t k = 0; k < kSome; ++k) matrices.push_back(uncertainty_loop(all[k].x, all[k].radii));
  test::SlicotSsv peer(9);
  for (auto _ : state) {
    double sum = 0.0;
    for (const Eigen::MatrixXcd& m : matrices) sum += peer.upper_bound(m).bound;
    benchmark::DoNotOptimize(sum);
  }
  report(state, "ssv_us_slicot", kSome);
}
BENCHMARK(slicot)->Name("ssv_us_slicot")->Unit(benchmark::kMicrosecond);
#endif

}  // namespace
}  // namespace fatmc

BENCHMARK_MAIN();
