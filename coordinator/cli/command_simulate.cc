// fatmc simulate: one flight as a record.
#include <filesystem>
#include <memory>

#include "campaigns/base/aircraft_model.h"
#include "campaigns/base/experiment.h"
#include "coordinator/cli/command.h"
#include "coordinator/input/record_file.h"
#include "coordinator/input/toml_file.h"
#include "core/flight/flight.h"

namespace fatmc::cli {
namespace {
