// The commands on campaigns as `fatmc` has them, with the study of tests/support instead of the shipped ones.
#include "coordinator/cli/command.h"

int main(int argc, char** argv) {
  CLI::App app("fatmc with the study of the tests", "fatmc");
  app.require_subcommand(1);
  fatmc::cli::Exit exit = fatmc::cli::Exit::done;
  fatmc::cli::add_run_command(app, exit);
  fatmc::cli::add_coordinator_command(app, exit);
  fatmc::cli::add_keygen_command(app, exit);
  fatmc::cli::add_status_command(app, exit);
  fatmc::cli::add_query_command(app, exit);
  fatmc::cli::add_digest_command(app, exit);
  fatmc::cli::add_merge_command(app, exit);
  fatmc::cli::add_migrate_command(app, exit);
  fatmc::cli::add_tables_command(app, exit);
  fatmc::cli::add_replay_command(app, exit);
  fatmc::cli::add_pause_command(app, exit);
  fatmc::cli::add_resume_command(app, exit);
  fatmc::cli::add_extend_command(app, exit);
  fatmc::cli::add_explain_command(app, exit);
  return fatmc::cli::run_application(app, exit, argc, argv);
}
