// fatmc keygen: keys for a coordinator and its workers.
#include <cstdio>
#include <memory>

#include "coordinator/cli/campaign_session.h"
#include "coordinator/cli/command.h"
#include "proto/key_files.h"

namespace fatmc::cli {

void add_keygen_command(CLI::App& app, Exit& exit) {
  auto folder = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand("keygen", "makes keys for a coordinator and its workers");
  command->footer(
      "Writes coordinator.key, coordinator.pub, worker.key and workers.pub (mode 0600) and overwrites "
      "nothing.\n"
      "Machines with workers need copies of worker.key and coordinator.pub; workers.pub lists whom the\n"
      "coordinator admits.\n"
      "Example: fatmc keygen keys");
  command->add_option("DIR", *folder, "folder, made where there is none")->required();
  command->callback([folder, &exit] {
    if (const Status status = write_key_files(*folder); !status) {
      exit = report(status.error());
      return;
    }
    const std::string line = shell_line({"--keys", *folder});
    std::printf("keys in %s: fatmc coordinator ... %s, fatmc-worker ... %s\n", folder->c_str(), line.c_str(),
                line.c_str());
    exit = Exit::done;
  });
}

}  // namespace fatmc::cli
