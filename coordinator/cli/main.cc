// fatmc: command line.
#include "coordinator/cli/model_commands.h"

namespace fatmc::cli {
namespace {

int run(int argc, char** argv) {
  CLI::App app("Monte Carlo campaigns for flight-dynamics identification.", "fatmc");
  app.require_subcommand(1);
  app.set_help_all_flag("--help-all", "help of all commands");
  Exit exit = Exit::done;
  add_run_command(app, exit);
  add_coordinator_command(app, exit);
  add_keygen_command(app, exit);
  add_status_command(app, exit);
  add_query_command(app, exit);
  add_digest_command(app, exit);
  add_merge_command(app, exit);
  add_migrate_command(app, exit);
  add_tables_command(app, exit);
  add_report_command(app, exit);
  add_replay_command(app, exit);
  add_pause_command(app, exit);
  add_resume_command(app, exit);
  add_extend_command(app, exit);
  add_explain_command(app, exit);
  add_linearize_command(app, exit);
  add_diagnose_command(app, exit);
  add_design_command(app, exit);
  add_simulate_command(app, exit);
  add_estimate_command(app, exit);
  add_predict_command(app, exit);
  add_noise_command(app, exit);
  add_ssv_command(app, exit);
  add_stability_command(app, exit);
  add_monitor_command(app, exit);
  add_identify_command(app, exit);
  add_select_command(app, exit);
  add_export_command(app, exit);
  return run_application(app, exit, argc, argv);
}

}  // namespace
}  // namespace fatmc::cli

int main(int argc, char** argv) { return fatmc::cli::run(argc, argv); }
