// The commands on campaigns as `fatmc` has them, with the study of tests/support instead of the shipped ones.
#include <cstdio>
#include <exception>

#include "coordinator/cli/command.h"

int main(int argc, char** argv) {
  CLI::App app("fatmc with the study of the tests", "fatmc");
  app.require_subcommand(1);
  fatmc::cli::Exit exit = fatmc::cli::Exit::done;
  fatmc::cli::add_run_command(app, exit);
  fatmc::cli::add_coordinator_command(app, exit);
  fatmc::cli::add_status_command(app, exit);
  fatmc::cli::add_query_command(app, exit);
  fatmc::cli::add_digest_command(app, exit);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    if (e.get_exit_code() == 0) return app.exit(e);
    std::fprintf(stderr, "fatmc: %s\n", e.what());
    return 2;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "fatmc: %s\n", e.what());
    return 1;
  }
  return static_cast<int>(exit);
}
