// What a run says when it is over.
#pragma once

#include <string>

#include "coordinator/cli/campaign_session.h"
#include "coordinator/cli/command.h"

namespace fatmc::cli {

/// Outcomes, how cells were stopped, tables.
Exit print_summary(const std::string& database);

/// The command that computes all that the database plans.
std::string extend_command(const SessionOptions& options);

/// Says so where the database plans more trials than the run asked for.
void report_rest(const SessionOptions& options);

/// Says which trials were given up, if any; the exit code then.
Exit report_quarantine(const SessionOptions& options);

}  // namespace fatmc::cli
