// A command of `fatmc`: adds its options to the application and, when chosen, does its work.
//
// Work happens in the CLI11 callback; it reports through Exit, never by calling exit(). Each command has a
// file of its own, command_<name>.cc, and a line in main.cc.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "core/base/error.h"

namespace fatmc::cli {

/// Exit codes of the command contract.
enum class Exit : int { done = 0, failed = 1, wrong_use = 2, partial = 3 };

/// Parses the command line, does what it says and makes sure that what was printed arrived; the exit code.
/// Whatever is wrong is one line on standard error.
int run_application(CLI::App& app, const Exit& exit, int argc, char** argv);

/// Prints the error as one line on standard error.
Exit report(const Error& error);

void add_linearize_command(CLI::App& app, Exit& exit);
void add_simulate_command(CLI::App& app, Exit& exit);
void add_diagnose_command(CLI::App& app, Exit& exit);
void add_design_command(CLI::App& app, Exit& exit);
void add_noise_command(CLI::App& app, Exit& exit);
void add_estimate_command(CLI::App& app, Exit& exit);
void add_predict_command(CLI::App& app, Exit& exit);
void add_run_command(CLI::App& app, Exit& exit);
void add_coordinator_command(CLI::App& app, Exit& exit);
void add_keygen_command(CLI::App& app, Exit& exit);
void add_status_command(CLI::App& app, Exit& exit);
void add_query_command(CLI::App& app, Exit& exit);
void add_digest_command(CLI::App& app, Exit& exit);
void add_merge_command(CLI::App& app, Exit& exit);
void add_migrate_command(CLI::App& app, Exit& exit);
void add_tables_command(CLI::App& app, Exit& exit);
void add_report_command(CLI::App& app, Exit& exit);
void add_replay_command(CLI::App& app, Exit& exit);
void add_pause_command(CLI::App& app, Exit& exit);
void add_resume_command(CLI::App& app, Exit& exit);
void add_extend_command(CLI::App& app, Exit& exit);
void add_explain_command(CLI::App& app, Exit& exit);
void add_ssv_command(CLI::App& app, Exit& exit);
void add_monitor_command(CLI::App& app, Exit& exit);
void add_identify_command(CLI::App& app, Exit& exit);
void add_stability_command(CLI::App& app, Exit& exit);

}  // namespace fatmc::cli
