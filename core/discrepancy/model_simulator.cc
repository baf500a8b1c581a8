#include "core/discrepancy/model_simulator.h"

#include <atomic>
#include <mutex>
#include <optional>
#include <thread>

#include "core/base/text.h"

namespace fatmc {
namespace {

TrialSeed null_seed(int flight) {
  return {0, name_hash("discrepancy"), name_hash("model"), static_cast<std::uint64_t>(flight)};
}

/// `work(i)` for i = 0 ... count-1 from several threads.
template <typename Work>
void share(int count, int threads, Work work) {
  std::atomic<int> next{0};
  const auto loop = [&] {
    for (int i = next++; i < count; i = next++) work(i);
  };
  std::vector<std::jthread> others;
  for (int t = 1; t < std::min(threads, count); ++t) others.emplace_back(loop);
  loop();
}

/// Counts flights for a progress function that wants one caller at a time.
class Counter {
 public:
  Counter(int total, const FlightProgress& progress) : total_(total), progress_(progress) {}
  void one() {
    if (!progress_) return;
    const std::lock_guard lock(mutex_);
    progress_(++done_, total_);
  }

 private:
  int total_, done_ = 0;
  const FlightProgress& progress_;
  std::mutex mutex_;
};

Result<LoopRecord> fly_one(const Flight& flight, const Eigen::MatrixX3d& reference,
                           const FeatureLayout& layout, int number) {
  FlightRecord flown;
  flight.fly(reference, null_seed(number), flown);
  if (flown.ending != Ending::completed) {
    return fail("the flight leaves the model (" + std::string(name(flown.ending)) + ") at " +
                significant(flown.ending_time_s, 3) + " s");
  }
  LoopRecord out;
  out.reference = std::move(flown.reference);
  out.input = std::move(flown.input);
  out.output = std::move(flown.output);
  if (layout.attitude) out.attitude = flown.auxiliary.leftCols(2);
  if (layout.airspeed) out.airspeed = flown.auxiliary.col(2);
  return out;
}

}  // namespace

ModelSimulator::ModelSimulator(Aircraft aircraft, FlightSetup setup, std::vector<Effect> own,
                               Eigen::MatrixX3d reference, FeatureExtractor extractor)
    : aircraft_(std::move(aircraft)),
      setup_(std::move(setup)),
      own_(std::move(own)),
      reference_(std::move(reference)),
      extractor_(std::move(extractor)) {}

Result<Flight> ModelSimulator::prepare(std::span<const Effect> effects) const {
  std::vector<Effect> all = own_;
  all.insert(all.end(), effects.begin(), effects.end());
  if (all.empty()) return Flight::prepare(aircraft_, setup_);
  auto modified = apply(aircraft_, setup_, all);
  if (!modified) return fail(modified.error());
  return Flight::prepare(modified->aircraft, modified->setup);
}

std::vector<EffectFlights> ModelSimulator::fly(std::span<const std::vector<Effect>> sets, int first,
                                               int count, int threads, const FlightProgress& progress) const {
  const int set_count = static_cast<int>(sets.size());
  std::vector<EffectFlights> out(sets.size());
  std::vector<std::optional<Flight>> flights(sets.size());
  share(set_count, threads, [&](int s) {
    const auto at = static_cast<std::size_t>(s);
    out[at].features.setZero(extractor_.layout().size, count);
    auto flight = prepare(sets[at]);
    if (flight) {
      flights[at].emplace(std::move(*flight));
    } else {
      out[at].failure = flight.error().text();
    }
  });
  std::vector<std::string> failures(sets.size() * static_cast<std::size_t>(count));
  Counter counter(set_count * count, progress);
  share(set_count * count, threads, [&](int job) {
    const auto s = static_cast<std::size_t>(job / count);
    const int n = job % count;
    if (flights[s]) {
      auto record = fly_one(*flights[s], reference_, extractor_.layout(), first + n);
      if (record) {
        out[s].features.col(n) = extractor_.extract(*record);
      } else {
        failures[static_cast<std::size_t>(job)] = record.error().message;
      }
    }
    counter.one();
  });
  for (std::size_t job = 0; job < failures.size(); ++job) {
    const std::size_t s = job / static_cast<std::size_t>(count);
    if (out[s].failure.empty()) out[s].failure = failures[job];
    if (flights[s] && failures[job].empty()) {
      out[s].completed.push_back(static_cast<int>(job % static_cast<std::size_t>(count)));
    }
  }
  return out;
}

Result<LoopRecord> ModelSimulator::record(std::span<const Effect> effects, int number) const {
  auto flight = prepare(effects);
  if (!flight) return fail(flight.error());
  return fly_one(*flight, reference_, extractor_.layout(), number);
}

Status ModelSimulator::visit_null(int count, int threads,
                                  const std::function<void(int, const LoopRecord&)>& visit,
                                  const FlightProgress& progress) const {
  auto flight = prepare({});
  if (!flight) return fail(flight.error());
  std::vector<std::string> failures(static_cast<std::size_t>(count));
  Counter counter(count, progress);
  share(count, threads, [&](int n) {
    auto record = fly_one(*flight, reference_, extractor_.layout(), n);
    if (record) {
      visit(n, *record);
    } else {
      failures[static_cast<std::size_t>(n)] = record.error().message;
    }
    counter.one();
  });
  for (const std::string& failure : failures) {
    if (!failure.empty()) return fail("the model does not survive the record's reference: " + failure);
  }
  return {};
}

}  // namespace fatmc
