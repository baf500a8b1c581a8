#include "coordinator/launch/launcher.h"

namespace fatmc {

std::string shell_word(const std::string& word) {
  const bool plain = !word.empty() && word.find_first_not_of(
                                          "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                                          "0123456789-_./:=,+@%") == std::string::npos;
  if (plain) return word;
  std::string out = "'";
  for (const char c : word) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

std::string command_line(const RemoteWorker& worker) {
  std::string out = shell_word(worker.program) + " --connect " + shell_word(worker.endpoint);
  if (!worker.keys.empty()) out += " --keys " + shell_word(worker.keys);
  return out + " --jobs " + std::to_string(worker.jobs) + " --leave-after " +
         std::to_string(worker.leave_after.count());
}

}  // namespace fatmc
