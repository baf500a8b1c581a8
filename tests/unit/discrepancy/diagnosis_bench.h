// The FAT on a short experiment, 2 x 40 s and 40 lines, with its law of chance from 300 flights: what tests of a diagnosis start from.
#pragma once

#include <gtest/gtest.h>

#include <memory>

#include "core/discrepancy/diagnosis.h"
#include "core/discrepancy/moment_filters.h"
#include "core/signal/multisine.h"
#include "tests/unit/flight/fat.h"

namespace fatmc {

inline constexpr int kPeriod = 2000;

struct DiagnosisBench {
  DiagnosisBench()
      : layout(*FeatureLayout::create(experiment(), true, true, true)),
        grid(*LpmGrid::create(experiment(), {}, 3)),
        model(
            with_moment_filters({fat(), setup(), {}, reference(), FeatureExtractor(layout, setup().gain)})) {
    layout = model.extractor().layout();
    options.flights = 300;
    options.threads = 2;
    // Every test is a process that learns the law anew: kinds with long grids, and some that are weak here, are left out.
    options.excluded = {"flexible_mode", "slosh",        "rate_limit", "position_limit",
                        "drag",          "cl_r",         "cy_beta",    "lift_of_elevator",
                        "thrust_line",   "surface_bias", "gyro_bias"};
    basis = std::make_unique<ComparisonBasis>(*ComparisonBasis::make(model, grid, options));
  }
  static PeriodicExperiment experiment() {
    std::vector<int> lines;
    for (int k = 12; k < 92; k += 2) lines.push_back(k);
    return {lines, kPeriod, 2, 50.0};
  }
  static FlightSetup setup() {
    FlightSetup out;
    out.turbulence_m_s = 0.5;
    out.imu = fat_model().imus.front();
    return out;
  }
  static Eigen::MatrixX3d reference() {
    Eigen::MatrixX3d out(2 * kPeriod, 3);
    RandomStream phases({1, name_hash("diagnosis test"), 0, 0}, "excitation");
    const double amplitude[] = {0.05, 0.03, 0.05};
    for (int axis = 0; axis < 3; ++axis) {
      const std::vector<double> r =
          Multisine::random_phase(kPeriod, experiment().lines, amplitude[axis], phases).samples(2);
      out.col(axis) = Eigen::Map<const Eigen::VectorXd>(r.data(), 2 * kPeriod);
    }
    return out;
  }
  /// What a stranger records: other noise than any flight of the model has.
  [[nodiscard]] Eigen::VectorXd record(const std::vector<Effect>& effects, std::uint64_t seed) const {
    const auto modified = apply(model.aircraft(), model.setup(), effects);
    const auto flight = Flight::prepare(modified->aircraft, modified->setup);
    FlightRecord flown;
    flight->fly(model.reference(), {seed, name_hash("stranger"), 0, 0}, flown);
    EXPECT_EQ(flown.ending, Ending::completed);
    return model.extractor().extract(
        {flown.reference, flown.input, flown.output, flown.auxiliary.leftCols(2), flown.auxiliary.col(2)});
  }
  [[nodiscard]] Diagnosis answer(const Eigen::VectorXd& features, int threads = 2) const {
    return diagnose(Comparison({{&model, basis.get(), features}}, threads), nullptr, {});
  }

  FeatureLayout layout;
  LpmGrid grid;
  ModelSimulator model;
  BasisOptions options;
  std::unique_ptr<ComparisonBasis> basis;
};

/// Suites share one bench a process.
class DiagnosisOfARecord : public testing::Test {
 protected:
  static void SetUpTestSuite() { bench_ = new DiagnosisBench; }
  static void TearDownTestSuite() {
    delete bench_;
    bench_ = nullptr;
  }
  inline static DiagnosisBench* bench_ = nullptr;
};

}  // namespace fatmc
