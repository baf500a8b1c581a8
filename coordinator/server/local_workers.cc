#include "coordinator/server/local_workers.h"

#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>

extern char** environ;

namespace fatmc {
namespace {

constexpr const char* kLeaveAfterSeconds = "10";
constexpr int kKeysDescriptor = 3;

// A worker computes one trial at a time, so that libraries with threads of their own would only fight for
// cores.
std::vector<std::string> worker_environment() {
  std::vector<std::string> out;
  for (char** entry = environ; *entry != nullptr; ++entry) out.emplace_back(*entry);
  for (const char* name : {"OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"}) {
    if (::getenv(name) == nullptr) out.push_back(std::string(name) + "=1");
  }
  return out;
}

std::vector<char*> pointers(std::vector<std::string>& texts) {
  std::vector<char*> out;
  for (std::string& text : texts) out.push_back(text.data());
  out.push_back(nullptr);
  return out;
}

std::string how_it_ended(int status) {
  if (WIFSIGNALED(status)) return std::string("signal ") + strsignal(WTERMSIG(status));
  return "exit code " + std::to_string(WEXITSTATUS(status));
}

// Done, wrong use, interrupted (worker/worker.h).
bool left_in_peace(int status) {
  if (!WIFEXITED(status)) return false;
  const int code = WEXITSTATUS(status);
  return code == 0 || code == 2 || code == 3;
}

}  // namespace

Result<std::string> worker_program_beside_this() {
  std::string program =
      (std::filesystem::read_symlink("/proc/self/exe").parent_path() / "fatmc-worker").string();
  if (::access(program.c_str(), X_OK) != 0) {
    return fail(Error{program, 0, "",
                      std::string("cannot be run (") + std::strerror(errno) +
                          "), put fatmc-worker beside fatmc or use `fatmc coordinator`"});
  }
  return program;
}

LocalWorkers::LocalWorkers(LocalWorkerOptions options) : options_(std::move(options)) {
  if (options_.keys) keys_ = open_worker_keys(*options_.keys);
}

LocalWorkers::~LocalWorkers() {
  stop(std::chrono::milliseconds(0));
  if (keys_ >= 0) ::close(keys_);
}

void LocalWorkers::start() {
  for (unsigned i = 0; i < options_.count; ++i) spawn();
}

void LocalWorkers::spawn() {
  std::vector<std::string> arguments{options_.program, "--connect",       options_.endpoint, "--jobs", "1",
                                     "--leave-after",  kLeaveAfterSeconds};
  if (options_.keys)
    arguments.insert(arguments.end(), {"--keys-descriptor", std::to_string(kKeysDescriptor)});
  if (options_.verbose) arguments.emplace_back("--verbose");
  std::vector<std::string> environment = worker_environment();
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t none;
  sigemptyset(&none);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", 0, 0);
  posix_spawn_file_actions_adddup2(&actions, 2, 1);  // standard output belongs to the tables
  if (options_.keys) posix_spawn_file_actions_adddup2(&actions, keys_, kKeysDescriptor);
  pid_t pid = 0;
  const int error = posix_spawn(&pid, options_.program.c_str(), &actions, &attributes,
                                pointers(arguments).data(), pointers(environment).data());
  posix_spawn_file_actions_destroy(&actions);
  posix_spawnattr_destroy(&attributes);
  if (error != 0) throw std::system_error(error, std::generic_category(), "cannot start " + options_.program);
  processes_.push_back(pid);
}

std::vector<EndedProcess> LocalWorkers::reap(std::uint64_t done) {
  std::vector<EndedProcess> ended;
  const std::vector<pid_t> before = processes_;
  for (const pid_t pid : before) {
    int status = 0;
    if (::waitpid(pid, &status, WNOHANG) != pid) continue;
    std::erase(processes_, pid);
    ended.push_back(
        {static_cast<std::uint32_t>(pid), left_in_peace(status) ? std::string() : how_it_ended(status)});
    judge(status, done);
  }
  return ended;
}

void LocalWorkers::judge(int status, std::uint64_t done) {
  if (WIFEXITED(status) && WEXITSTATUS(status) == 2) {  // it said why, and would say it again
    if (processes_.empty()) failure_ = "no worker can run this campaign";
    return;
  }
  crashes_ = done > done_at_last_crash_ ? 1 : crashes_ + 1;
  done_at_last_crash_ = done;
  if (crashes_ >= options_.crashes_in_vain) {
    failure_ = "workers ended " + std::to_string(crashes_) +
               " times without a trial done in between, at last by " + how_it_ended(status);
    return;
  }
  ++restarts_;
  spawn();
}

void LocalWorkers::stop(std::chrono::milliseconds patience) {
  const auto deadline = std::chrono::steady_clock::now() + patience;
  for (const int signal : {0, SIGTERM, SIGKILL}) {
    if (signal != 0) {
      for (const pid_t pid : processes_) ::kill(pid, signal);
    }
    const auto until = signal == 0 ? deadline : std::chrono::steady_clock::now() + std::chrono::seconds(1);
    do {
      std::erase_if(processes_, [](pid_t pid) {
        int status = 0;
        return ::waitpid(pid, &status, WNOHANG) == pid;
      });
      if (processes_.empty()) return;
      ::poll(nullptr, 0, 2);
    } while (std::chrono::steady_clock::now() < until);
  }
}

}  // namespace fatmc
