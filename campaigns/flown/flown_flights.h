// Flights of one cell and their estimates: what the trials of flown studies have in common.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <mutex>
#include <vector>

#include "campaigns/base/study.h"
#include "campaigns/flown/flown_cell.h"
#include "core/flight/flight.h"
#include "core/ident/fast_lpm.h"

namespace fatmc {

/// Everything a cell's trials share, prepared once; const afterwards and safe to use from several threads at once.
class FlownFlights {
 public:
  /// The error names file, line and key.
  static Result<std::unique_ptr<const FlownFlights>> prepare(const CampaignSpec& spec, std::uint32_t cell,
                                                             FlownCell flown);

  /// What a flight and its estimate need room for; kept from trial to trial.
  struct Workspace {
    explicit Workspace(const LpmGrid& grid) : estimator(grid, 3) {}
    FlightRecord record;
    FastLpm estimator;
    FrmEstimate corrected;  ///< the estimate, referred to the trim speed
  };
  /// A workspace that no other thread has; it returns to its flights with the lease.
  class Lease {
   public:
    Lease(const FlownFlights& owner, std::unique_ptr<Workspace> workspace)
        : owner_(owner), workspace_(std::move(workspace)) {}
    ~Lease() { owner_.give_back(std::move(workspace_)); }
    Lease(const Lease&) = delete;
    Lease& operator=(const Lease&) = delete;
    Workspace* operator->() const { return workspace_.get(); }
    Workspace& operator*() const { return *workspace_; }

   private:
    const FlownFlights& owner_;
    std::unique_ptr<Workspace> workspace_;
  };
  [[nodiscard]] Lease borrow() const;

  [[nodiscard]] TrialSeed seed(std::uint64_t repetition) const;
  /// Flies `repetition` into the workspace's record. False where the flight ended early; the row's outcome is then
  /// "diverged" and its detail says how.
  bool fly(std::uint64_t repetition, Workspace& workspace, TrialRow& row) const;
  /// Fast LPM, indirect, of the flown record, speed-corrected where the cell says so. Null where a line has no
  /// estimate; the row's outcome is then "singular". Valid until the workspace is used again.
  const FrmEstimate* estimate(Workspace& workspace, TrialRow& row) const;
  /// Metrics of the record: rms of the commands, shares at servo limits, largest bank and pitch.
  static void describe(const FlightRecord& record, TrialRow& row);
  /// The channels of a repetition, flown again.
  [[nodiscard]] TrialRecord record(std::uint64_t repetition) const;

  [[nodiscard]] const FlownCell& cell() const { return cell_; }
  [[nodiscard]] const Flight& flight() const { return flight_; }
  [[nodiscard]] const LpmGrid& grid() const { return grid_; }
  /// G0 at the lines: response of the sampled step map.
  [[nodiscard]] const std::vector<Eigen::Matrix3cd>& truth() const { return truth_; }
  /// Key of a repetition in this cell.
  [[nodiscard]] TrialKey key(std::uint64_t repetition) const { return {key_.cell, repetition}; }

 private:
  FlownFlights(FlownCell cell, Flight flight, LpmGrid grid, TrialSeed seed, TrialKey key);
  void give_back(std::unique_ptr<Workspace> workspace) const;

  FlownCell cell_;
  Flight flight_;
  LpmGrid grid_;
  TrialSeed seed_;
  TrialKey key_;
  std::vector<Eigen::Matrix3cd> truth_;
  mutable std::mutex mutex_;
  mutable std::vector<std::unique_ptr<Workspace>> idle_;
};

}  // namespace fatmc
