// What a run says when it is over.
#pragma once

#include <string>

#include "coordinator/cli/campaign_session.h"
#include "coordinator/cli/command.h"

namespace fatmc::cli {

/// Outcomes, how cells were stopped, tables.
Exit print_summary(const std::string& database);

/// Says which trials were given up, if any; the exit code then.
Exit report_quarantine(const SessionOptions& options);

}  // namespace fatmc::cli
