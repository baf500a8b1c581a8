// `fatmc query sensitivity`, a command inside another.
#pragma once

#include "coordinator/cli/command.h"

namespace fatmc::cli {

void add_sensitivity_command(CLI::App& query, Exit& exit);

}  // namespace fatmc::cli
