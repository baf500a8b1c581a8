// T 3.2.4: is 0.02 s short enough for the integration? Fifty records of the chapter 5 experiment, flown with
// steps of 0.02 s and of 0.005 s; commands, gusts and their random numbers are the same. The statement under
// test: no element of the mean response leaves its 95 % interval.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <vector>

#include "campaigns/base/aircraft_model.h"
#include "campaigns/base/experiment.h"
#include "coordinator/input/toml_file.h"
#include "core/flight/flight.h"
#include "core/ident/fast_lpm.h"
#include "core/stats/confidence.h"

namespace fatmc {
namespace {

constexpr int kRepetitions = 50;

// Mean response and the standard error of that mean, line by line, output by output, input by input.
struct MeanResponse {
  std::vector<std::complex<double>> mean;
  std::vector<double> standard_error;  // complex: sqrt(E|x - E x|²)
};

MeanResponse fly_fifty(const Aircraft& aircraft, Experiment experiment, double step_s) {
  experiment.flight.step_s = step_s;
  const auto flight = Flight::prepare(aircraft, experiment.flight);
  EXPECT_TRUE(flight) << flight.error().text();
  const Excitation& excitation = experiment.excitation;
  const auto grid =
      LpmGrid::create({excitation.lines, excitation.period_samples, excitation.periods, 50.0}, {}, 3);
  FastLpm estimator(*grid, 3);
  FlightRecord record;
  std::vector<std::vector<std::complex<double>>> runs;
  for (std::uint64_t repetition = 0; repetition < kRepetitions; ++repetition) {
    const TrialSeed seed{2018, name_hash("step size"), 0, repetition};
    flight->fly(reference_signal(experiment, seed), seed, record);
    EXPECT_EQ(record.ending, Ending::completed);
    estimator.load(record.output, record.input);
    FrmEstimate frm = estimator.indirect(spectra_at_lines(*grid, record.reference));
    scale_response(frm, aircraft.speed_m_s / record.auxiliary.col(2).mean());
    std::vector<std::complex<double>> response;
    for (int k = 0; k < frm.line_count(); ++k) {
      for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) response.push_back(frm.G[k](i, j));
      }
    }
    runs.push_back(std::move(response));
  }
  MeanResponse out;
  out.mean.resize(runs.front().size());
  out.standard_error.resize(runs.front().size());
  for (std::size_t e = 0; e < out.mean.size(); ++e) {
    for (const auto& run : runs) out.mean[e] += run[e] / static_cast<double>(kRepetitions);
    double sum = 0.0;
    for (const auto& run : runs) sum += std::norm(run[e] - out.mean[e]);
    out.standard_error[e] = std::sqrt(sum / (kRepetitions - 1) / kRepetitions);
  }
  return out;
}

TEST(StepSize, AQuarterOfTheStepMovesNoElementOfTheMeanResponseOutsideItsInterval) {
  const auto model = read_toml_resolved("campaigns/models/fat.toml");
  const auto file = read_toml_resolved("campaigns/experiments/chapter5.toml");
  ASSERT_TRUE(model && file);
  const auto aircraft = decode_aircraft_model(*model);
  ASSERT_TRUE(aircraft);
  const auto experiment = decode_experiment(*file, *aircraft);
  ASSERT_TRUE(experiment);
  const MeanResponse coarse = fly_fifty(aircraft->aircraft, *experiment, 0.02);
  const MeanResponse fine = fly_fifty(aircraft->aircraft, *experiment, 0.005);
  const double limit = std::sqrt(f_quantile_2_2q(0.95, kRepetitions - 1));
  double largest = 0.0;
  std::size_t outside = 0;
  for (std::size_t e = 0; e < coarse.mean.size(); ++e) {
    const double moved = std::abs(fine.mean[e] - coarse.mean[e]) / coarse.standard_error[e];
    largest = std::max(largest, moved);
    outside += moved > limit ? 1 : 0;
  }
  RecordProperty("largest_move_over_interval", std::to_string(largest / limit));
  EXPECT_EQ(outside, 0U) << "largest move: " << largest / limit << " of the interval's radius, " << outside
                         << " of " << coarse.mean.size() << " elements outside";
}

}  // namespace
}  // namespace fatmc
