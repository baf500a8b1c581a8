#include "coordinator/launch/child_command.h"

#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <utility>

#include "core/base/check.h"

extern char** environ;

namespace fatmc {
namespace {

constexpr std::size_t kMostErrors = 200;

// Anonymous files instead of pipes: whatever the command writes, nobody has to read at the same time.
int anonymous_file() {
  const int descriptor = ::memfd_create("fatmc-command", MFD_CLOEXEC);
  FATMC_CHECK(descriptor >= 0, "out of file descriptors");
  return descriptor;
}

std::string take_text(int& descriptor) {
  std::string out;
  char buffer[4096];
  ::lseek(descriptor, 0, SEEK_SET);
  for (ssize_t size = 0; (size = ::read(descriptor, buffer, sizeof buffer)) > 0;)
    out.append(buffer, static_cast<std::size_t>(size));
  ::close(std::exchange(descriptor, -1));
  return out;
}

int input_file(const std::string& input) {
  const int descriptor = anonymous_file();
  FATMC_CHECK(::write(descriptor, input.data(), input.size()) == static_cast<ssize_t>(input.size()),
              "an anonymous file takes a write");
  ::lseek(descriptor, 0, SEEK_SET);
  return descriptor;
}

}  // namespace

ChildCommand::~ChildCommand() {
  if (running()) {
    ::kill(-pid_, SIGKILL);
    ::waitpid(pid_, nullptr, 0);
  }
  for (const int descriptor : {output_, errors_})
    if (descriptor >= 0) ::close(descriptor);
}

void ChildCommand::start(const std::vector<std::string>& arguments, const std::string& input, Time deadline) {
  FATMC_CHECK(!running() && !early_, "a command runs one at a time");
  const int in = input_file(input);
  output_ = anonymous_file();
  errors_ = anonymous_file();
  std::vector<std::string> copies = arguments;
  std::vector<char*> pointers;
  for (std::string& copy : copies) pointers.push_back(copy.data());
  pointers.push_back(nullptr);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t none;
  sigemptyset(&none);
  posix_spawnattr_setsigmask(&attributes, &none);
  // A group of its own: Ctrl-C on the terminal is for the coordinator, which ends workers in order.
  posix_spawnattr_setpgroup(&attributes, 0);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETPGROUP);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, in, 0);
  posix_spawn_file_actions_adddup2(&actions, output_, 1);
  posix_spawn_file_actions_adddup2(&actions, errors_, 2);
  const int error = posix_spawnp(&pid_, pointers[0], &actions, &attributes, pointers.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  posix_spawnattr_destroy(&attributes);
  ::close(in);
  deadline_ = deadline;
  if (error == 0) return;
  pid_ = -1;
  ::close(std::exchange(output_, -1));
  ::close(std::exchange(errors_, -1));
  early_ = CommandResult{127, "", arguments.front() + ": " + std::strerror(error)};
}

std::optional<CommandResult> ChildCommand::take(Time now) {
  if (early_) return std::exchange(early_, std::nullopt);
  if (!running()) return std::nullopt;
  int status = 0;
  const bool late = now >= deadline_;
  if (late) ::kill(-pid_, SIGKILL);
  if (::waitpid(pid_, &status, late ? 0 : WNOHANG) != pid_) return std::nullopt;
  pid_ = -1;
  CommandResult result;
  result.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  result.output = take_text(output_);
  result.errors = take_text(errors_);
  result.errors = result.errors.substr(0, std::min(result.errors.find('\n'), kMostErrors));
  if (late) result.errors = "no answer in time" + (result.errors.empty() ? "" : ": " + result.errors);
  return result;
}

CommandResult run_command(const std::vector<std::string>& arguments, const std::string& input,
                          std::chrono::milliseconds patience) {
  ChildCommand command;
  command.start(arguments, input, std::chrono::steady_clock::now() + patience);
  for (;;) {
    if (auto result = command.take(std::chrono::steady_clock::now())) return *result;
    ::poll(nullptr, 0, 5);
  }
}

}  // namespace fatmc
