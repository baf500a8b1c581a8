#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <iostream>

#include "coordinator/cli/command.h"
#include "core/base/text.h"

namespace fatmc::cli {
namespace {

// CLI11 finds a command missing before it looks at the word that stands in its place.
std::string what_is_wrong(const CLI::App& app, const CLI::ParseError& error) {
  const std::vector<std::string> unknown = app.remaining();
  if (!app.get_subcommands().empty() || unknown.empty()) return error.what();
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(command->get_name());
  return "\"" + unknown.front() + "\" is no command, write one of: " + join(names);
}

int parse(CLI::App& app, const Exit& exit, int argc, char** argv) {
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    if (e.get_exit_code() == 0) return app.exit(e);  // --help
    std::fprintf(stderr, "fatmc: %s (fatmc --help lists commands and options)\n",
                 what_is_wrong(app, e).c_str());
    return static_cast<int>(Exit::wrong_use);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "fatmc: %s\n", e.what());
    return static_cast<int>(Exit::failed);
  }
  return static_cast<int>(exit);
}

}  // namespace

int run_application(CLI::App& app, const Exit& exit, int argc, char** argv) {
  const int code = parse(app, exit, argc, argv);
  errno = 0;
  std::cout.flush();
  const bool lost = std::fflush(stdout) != 0 || std::ferror(stdout) != 0 || !std::cout;
  if (!lost) return code;
  const std::string reason = errno != 0 ? std::string(" (") + std::strerror(errno) + ")" : "";
  std::fprintf(stderr, "fatmc: standard output could not be written%s, what was printed is lost\n",
               reason.c_str());
  return code != 0 ? code : static_cast<int>(Exit::failed);
}

}  // namespace fatmc::cli
