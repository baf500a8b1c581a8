// The model flown on a record's own reference, with effects, many times.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "core/discrepancy/record_features.h"
#include "core/flight/effects/effect.h"
#include "core/flight/flight.h"

namespace fatmc {

/// Told how many flights of how many are done; called from one thread at a time.
using FlightProgress = std::function<void(int done, int total)>;

/// Flights of one set of effects.
struct EffectFlights {
  Eigen::MatrixXd features;    ///< layout size x flights; zeros where a flight has no result
  std::vector<int> completed;  ///< flights with a result, counted from the first one flown
  std::string failure;         ///< empty, or why at least one flight has no result (diverged, no trim)
  [[nodiscard]] bool usable() const { return failure.empty(); }
};

/// Flight number n has the noise of (a fixed seed, n), whatever the effects: differences between sets of effects are free of
/// most of the noise (common random numbers). Const after construction, may be shared by threads.
class ModelSimulator {
 public:
  /// `own`: effects that belong to the model itself (earlier patches); those of a set are added to them.
  ModelSimulator(Aircraft aircraft, FlightSetup setup, std::vector<Effect> own, Eigen::MatrixX3d reference,
                 FeatureExtractor extractor);

  [[nodiscard]] const Aircraft& aircraft() const { return aircraft_; }
  [[nodiscard]] const FlightSetup& setup() const { return setup_; }
  [[nodiscard]] const std::vector<Effect>& own_effects() const { return own_; }
  [[nodiscard]] const Eigen::MatrixX3d& reference() const { return reference_; }
  [[nodiscard]] const FeatureExtractor& extractor() const { return extractor_; }

  /// Flights `first` ... `first + count - 1` of every set, in `threads` threads; results do not depend on how many.
  [[nodiscard]] std::vector<EffectFlights> fly(std::span<const std::vector<Effect>> sets, int first,
                                               int count, int threads,
                                               const FlightProgress& progress = {}) const;
  /// One flight as a record; the failure is its error.
  [[nodiscard]] Result<LoopRecord> record(std::span<const Effect> effects, int flight) const;
  /// `visit(n, record)` for flights of the model alone, from `threads` threads at once.
  Status visit_null(int count, int threads, const std::function<void(int, const LoopRecord&)>& visit,
                    const FlightProgress& progress = {}) const;

 private:
  [[nodiscard]] Result<Flight> prepare(std::span<const Effect> effects) const;

  Aircraft aircraft_;
  FlightSetup setup_;
  std::vector<Effect> own_;
  Eigen::MatrixX3d reference_;
  FeatureExtractor extractor_;
};

}  // namespace fatmc
