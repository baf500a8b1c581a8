// Commands that choose a model among many and write it as a MODEL file.
#pragma once

#include "coordinator/cli/command.h"

namespace fatmc::cli {

/// Of records: fatmc select.
void add_select_command(CLI::App& app, Exit& exit);
/// Of a database of the candidates study: fatmc export.
void add_export_command(CLI::App& app, Exit& exit);

}  // namespace fatmc::cli
