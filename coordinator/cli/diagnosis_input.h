// What `fatmc diagnose` works on: the model, records as the comparison reads them, and what is known of each experiment.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "campaigns/base/aircraft_model.h"
#include "core/discrepancy/comparison_basis.h"
#include "core/discrepancy/loop_record.h"

namespace fatmc::cli {

struct DiagnosedModel {
  std::string path;
  std::string text;  ///< the file, byte by byte
  AircraftModel model;
  std::vector<Effect> effects;  ///< that the model carries already
};

/// A record, the simulator of its experiment, and how its law is to be made.
struct DiagnosedRecord {
  std::string path;
  std::string data_hash;  ///< SHA-256 of the samples' file
  LoopRecord record;
  PeriodicExperiment experiment;
  FlightSetup setup;
  bool gain_stated = false;
  bool turbulence_stated = false;
  std::vector<std::string> assumptions;  ///< what neither model nor record says, one sentence each
};

Result<DiagnosedModel> read_diagnosed_model(const std::string& path);

/// Reads and checks the record: three references, inputs and outputs of a rate loop, two periods, plausible units, no
/// saturated channel. The error is one line that names what does not fit and the remedy.
Result<DiagnosedRecord> read_diagnosed_record(const std::string& path, const DiagnosedModel& model);

/// Features of the record, with the simulator that flies the model on its reference. Where no one states the turbulence, it
/// is estimated from the record's noise and noted.
struct PreparedRecord {
  std::unique_ptr<ModelSimulator> model;
  LpmGrid grid;
  BasisOptions basis;
  Eigen::VectorXd features;
};
Result<PreparedRecord> prepare_record(DiagnosedRecord& record, const DiagnosedModel& model,
                                      const std::vector<Effect>& effects, int threads);

/// SHA-256 over everything the basis depends on.
std::string basis_key(const PreparedRecord& record, const DiagnosedModel& model);

}  // namespace fatmc::cli
