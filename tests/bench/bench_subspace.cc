// PBSIDopt models of many windows and orders: shared factorisations beside one direct computation a model.
//
// 4 maneuvers of 500 samples, 2 inputs, 3 outputs, lambda fixed: p = 60, 50, ..., 20, f = 20, 30, ... up to p,
// n = 4 ... 10, that is 15 windows and 105 models.
#include <benchmark/benchmark.h>

#include <vector>

#include "core/random/random_stream.h"
#include "core/subspace/model_family.h"

namespace fatmc {
namespace {

constexpr Eigen::Index kSamples = 500, kInputs = 2, kOutputs = 3;

std::vector<Maneuver> maneuvers() {
  std::vector<Maneuver> out;
  for (const std::uint64_t part : {1, 2, 3, 4}) {
    RandomStream stream({part, 0, 0, 0}, "bench");
    Maneuver m{Eigen::MatrixXd(kSamples, kInputs), Eigen::MatrixXd::Zero(kSamples, kOutputs)};
    for (Eigen::Index t = 0; t < kSamples; ++t) {
      for (Eigen::Index j = 0; j < kInputs; ++j) m.inputs(t, j) = stream.normal();
      for (Eigen::Index i = 0; i < kOutputs; ++i) {
        if (t >= 2) {
          m.outputs(t, i) = (1.5 - 0.2 * static_cast<double>(i)) * m.outputs(t - 1, i) -
                            0.7 * m.outputs(t - 2, i) + 0.05 * m.outputs(t - 2, (i + 1) % kOutputs) +
                            m.inputs(t - 1, i % kInputs);
        }
        m.outputs(t, i) += 0.3 * stream.normal();
      }
    }
    out.push_back(std::move(m));
  }
  return out;
}

FamilyPlan plan() {
  FamilyPlan out;
  out.pasts = {60, 50, 40, 30, 20};
  out.futures = {20, 30, 40, 50, 60};
  out.lowest_order = 4;
  out.highest_order = 10;
  out.regularization = {Regularization::fixed, 1.0};
  return out;
}

void shared(benchmark::State& state) {
  const std::vector<Maneuver> data = maneuvers();
  int models = 0;
  for (auto _ : state) {
    models = 0;
    const Status status = identify_family(
        data, plan(),
        [&](const FamilyMember&, const Result<PbsidModel>& model) { models += model.has_value() ? 1 : 0; });
    if (!status || models != 105) return state.SkipWithError("a model was not identified");
  }
  state.counters["pbsid_shared_over_direct"] =
      benchmark::Counter(static_cast<double>(state.iterations()) * models, benchmark::Counter::kIsRate);
}

void direct(benchmark::State& state) {
  const std::vector<Maneuver> data = maneuvers();
  const FamilyPlan what = plan();
  int models = 0;
  for (auto _ : state) {
    models = 0;
    for (const int past : what.pasts) {
      for (const int future : what.futures) {
        for (int order = what.lowest_order; future <= past && order <= what.highest_order; ++order)
          models +=
              identify_pbsid(data, {past, future, order, what.regularization, what.final_regression}) ? 1 : 0;
      }
    }
    if (models != 105) return state.SkipWithError("a model was not identified");
  }
  state.counters["pbsid_direct_per_s"] =
      benchmark::Counter(static_cast<double>(state.iterations()) * models, benchmark::Counter::kIsRate);
}

BENCHMARK(shared)->Name("pbsid_models/shared")->Unit(benchmark::kMillisecond);
BENCHMARK(direct)->Name("pbsid_models/direct")->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace fatmc

BENCHMARK_MAIN();
