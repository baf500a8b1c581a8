// fatmc: command line.
#include <cstdio>
#include <exception>

#include "coordinator/cli/command.h"

namespace fatmc::cli {
namespace {

int run(int argc, char** argv) {
  CLI::App app("Monte Carlo campaigns for flight-dynamics identification.", "fatmc");
  app.require_subcommand(1);
  app.set_help_all_flag("--help-all", "help of all commands");
  Exit exit = Exit::done;
  add_run_command(app, exit);
  add_coordinator_command(app, exit);
  add_status_command(app, exit);
  add_query_command(app, exit);
  add_digest_command(app, exit);
  add_tables_command(app, exit);
  add_linearize_command(app, exit);
  add_simulate_command(app, exit);
  add_estimate_command(app, exit);
  add_ssv_command(app, exit);
  add_stability_command(app, exit);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    if (e.get_exit_code() == 0) return app.exit(e);  // --help
    std::fprintf(stderr, "fatmc: %s (fatmc --help lists commands and options)\n", e.what());
    return static_cast<int>(Exit::wrong_use);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "fatmc: %s\n", e.what());
    return static_cast<int>(Exit::failed);
  }
  return static_cast<int>(exit);
}

}  // namespace
}  // namespace fatmc::cli

int main(int argc, char** argv) { return fatmc::cli::run(argc, argv); }
