// Speed of the closed loop: Runge-Kutta steps a second of aircraft, servos, turbulence, gyros and controller.
#include <benchmark/benchmark.h>

#include "campaigns/base/aircraft_model.h"
#include "coordinator/input/toml_file.h"
#include "core/flight/flight.h"

namespace fatmc {
namespace {

const AircraftModel& fat() {
  static const AircraftModel model = [] {
    const Result<Tree> tree = read_toml("campaigns/models/fat.toml");
    if (!tree) throw std::runtime_error(tree.error().text());
    const Result<AircraftModel> decoded = decode_aircraft_model(*tree);
    if (!decoded) throw std::runtime_error(decoded.error().text());
    return *decoded;
  }();
  return model;
}

Eigen::MatrixX3d reference() {
  constexpr Eigen::Index ticks = 20000;  // 400 s at 50 Hz
  Eigen::MatrixX3d r(ticks, 3);
  for (Eigen::Index t = 0; t < ticks; ++t) {
    const double s = 0.02 * static_cast<double>(t);
    r.row(t) << 0.1 * std::sin(3.0 * s), 0.1 * std::sin(4.0 * s), 0.1 * std::sin(5.0 * s);
  }
  return r;
}

void closed_loop(benchmark::State& state, FlightSetup::Plant plant, double step_s, double turbulence) {
  FlightSetup setup;
  setup.imu = *fat().imu("tactical");
  setup.turbulence_m_s = turbulence;
  setup.plant = plant;
  setup.step_s = step_s;
  const Result<Flight> flight = Flight::prepare(fat().aircraft, setup);
  const Eigen::MatrixX3d r = reference();
  FlightRecord record;
  TrialSeed trial{1, 2, 3, 0};
  for (auto _ : state) {
    flight->fly(r, trial, record);
    ++trial.repetition;
    if (record.ending != Ending::completed) state.SkipWithError("the flight diverged");
    benchmark::DoNotOptimize(record.output.data());
  }
  const double steps = static_cast<double>(r.rows()) * 0.02 / step_s;
  state.counters["sim_steps_per_s"] =
      benchmark::Counter(steps * static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}

BENCHMARK_CAPTURE(closed_loop, nonlinear_record_400_s, FlightSetup::Plant::nonlinear, 0.02, 0.5)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(closed_loop, nonlinear_step_5_ms, FlightSetup::Plant::nonlinear, 0.005, 0.5)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(closed_loop, nonlinear_calm, FlightSetup::Plant::nonlinear, 0.02, 0.0)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(closed_loop, linear_record_400_s, FlightSetup::Plant::linear, 0.02, 0.5)
    ->Unit(benchmark::kMillisecond);

void prepare(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(Flight::prepare(fat().aircraft, FlightSetup{}));
}
BENCHMARK(prepare)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace fatmc

BENCHMARK_MAIN();
