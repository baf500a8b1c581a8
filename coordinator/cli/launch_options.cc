#include "coordinator/cli/launch_options.h"

#include <filesystem>

#include "coordinator/launch/host_launcher.h"
#include "coordinator/launch/slurm_launcher.h"
#include "coordinator/server/local_workers.h"
#include "core/base/text.h"
#include "proto/endpoint.h"
#include "proto/host_name.h"
#include "proto/key_files.h"

namespace fatmc::cli {
namespace {

namespace fs = std::filesystem;

tl::unexpected<Error> wrong(const char* option, const std::string& message) {
  return fail(Error{"", 0, option, message});
}

// Of the dynamic ports (RFC 6335), one that the campaign's identity chooses.
unsigned campaign_port(const CampaignSpec& spec) {
  return 49152U + static_cast<unsigned>(std::stoul(spec.identity().substr(0, 8), nullptr, 16) % 16384U);
}

// The endpoint as seen from elsewhere.
std::string seen_endpoint(const LaunchOptions& options, const std::string& bound) {
  const std::size_t colon = bound.rfind(':');
  std::string host = bound.substr(6, colon - 6);
  if (host == "0.0.0.0" || host == "*" || host == "[::]") host = host_name();
  if (!options.advertise.empty()) host = options.advertise;
  return "tcp://" + host + bound.substr(colon);
}

}  // namespace

void add_launch_options(CLI::App& command, LaunchOptions& options) {
  const char* group = "Workers elsewhere (docs/scale.md)";
  command
      .add_option("--launcher", options.launcher,
                  "local: processes here; slurm: pilots through sbatch; ssh: one worker on each of --hosts")
      ->check(CLI::IsMember({"local", "slurm", "ssh"}))
      ->capture_default_str()
      ->group(group);
  command
      .add_option("--hosts", options.hosts,
                  "ssh: hosts and trials at a time, for instance node1:8,ada@node2:4")
      ->group(group);
  command
      .add_option(
          "--launch-line", options.line,
          "ssh: the line that starts {command} on {host} (default: ssh -o BatchMode=yes {host} {command})")
      ->group(group);
  command
      .add_option("--sbatch", options.sbatch, "slurm: an argument for sbatch, for instance --partition=long")
      ->allow_extra_args(false)
      ->group(group);
  command.add_option("--jobs", options.jobs, "slurm: trials at a time (and cores) of a pilot")
      ->check(CLI::Range(1, 4096))
      ->capture_default_str()
      ->group(group);
  command
      .add_option("--bind", options.bind, "where to listen (default: all interfaces, a port of the campaign)")
      ->group(group);
  command
      .add_option("--advertise", options.advertise, "this host's name as workers see it (default: its own)")
      ->group(group);
  command
      .add_option("--keys", options.keys,
                  "folder of keys on a file system that workers share (default: DB.keys, made when missing)")
      ->group(group);
  command.add_option("--worker-program", options.program, "path of fatmc-worker there (default: as here)")
      ->group(group);
  command
      .add_option("--worker-patience", options.leave_after_s,
                  "seconds for which workers wait for a coordinator that is gone")
      ->check(CLI::Range(1.0, 1e6))
      ->capture_default_str()
      ->group(group);
}

std::vector<std::string> words_of(const LaunchOptions& options) {
  std::vector<std::string> words;
  if (options.is_local()) return words;
  const auto add = [&](const char* option, const std::string& value) {
    if (!value.empty()) words.insert(words.end(), {option, value});
  };
  add("--launcher", options.launcher);
  add("--hosts", options.hosts);
  add("--launch-line", options.line);
  for (const std::string& argument : options.sbatch) words.push_back("--sbatch=" + argument);
  if (options.jobs != 1) add("--jobs", std::to_string(options.jobs));
  add("--bind", options.bind);
  add("--advertise", options.advertise);
  add("--keys", options.keys);
  add("--worker-program", options.program);
  if (options.leave_after_s != 300.0) add("--worker-patience", shortest(options.leave_after_s));
  return words;
}

Status check(const LaunchOptions& options) {
  const bool ssh = options.launcher == "ssh";
  if (ssh && options.hosts.empty())
    return wrong("--hosts", "is missing, write for instance --hosts node1:8,node2:8");
  if (!ssh && !options.hosts.empty()) return wrong("--hosts", "is for --launcher ssh, write that, too");
  if (!ssh && !options.line.empty()) return wrong("--launch-line", "is for --launcher ssh, write that, too");
  if (options.launcher != "slurm" && !options.sbatch.empty())
    return wrong("--sbatch", "is for --launcher slurm, write that, too");
  if (options.is_local() && !(options.bind + options.advertise + options.keys + options.program).empty()) {
    return wrong("--launcher",
                 "is local, whose workers need no address and no keys; write --launcher slurm or ssh, or "
                 "use fatmc coordinator");
  }
  if (ssh) {
    if (const auto hosts = parse_hosts(options.hosts); !hosts) return fail(hosts.error());
    if (!options.line.empty()) {
      if (const auto line = fill_line(options.line, "h", "c"); !line) return fail(line.error());
    }
  }
  if (!options.bind.empty()) return check_endpoint(options.bind, "--bind", Protection::curve);
  return {};
}

std::string bind_endpoint(const LaunchOptions& options, const CampaignSpec& spec) {
  return options.bind.empty() ? "tcp://*:" + std::to_string(campaign_port(spec)) : options.bind;
}

Result<std::string> key_folder(const LaunchOptions& options, const std::string& database) {
  if (!options.keys.empty()) return options.keys;
  std::string folder = database + ".keys";
  if (fs::exists(folder)) return folder;
  if (const Status made = write_key_files(folder); !made) return fail(made.error());
  return folder;
}

Result<std::unique_ptr<Launcher>> make_launcher(const LaunchOptions& options, const CampaignSpec& spec,
                                                const std::string& database, const std::string& keys,
                                                const std::string& bound, std::uint64_t most) {
  RemoteWorker worker;
  worker.program = options.program;
  if (worker.program.empty()) {
    const Result<std::string> here = worker_program_beside_this();
    if (!here) return fail(here.error());
    worker.program = *here;
  }
  worker.endpoint = seen_endpoint(options, bound);
  worker.keys = fs::absolute(keys).lexically_normal().string();
  worker.jobs = options.jobs;
  worker.leave_after = std::chrono::seconds(static_cast<std::int64_t>(options.leave_after_s));
  if (options.launcher == "ssh") {
    const Result<std::vector<Host>> hosts = parse_hosts(options.hosts);
    if (!hosts) return fail(hosts.error());
    HostOptions host_options;
    host_options.worker = worker;
    host_options.hosts = *hosts;
    if (!options.line.empty()) host_options.line = options.line;
    return std::make_unique<HostLauncher>(std::move(host_options));
  }
  SlurmOptions slurm;
  slurm.worker = worker;
  slurm.pilots = most;
  slurm.name = pilot_name(spec.identity(), worker.endpoint);
  slurm.log_folder = fs::absolute(database + ".pilots").lexically_normal().string();
  slurm.arguments = options.sbatch;
  std::error_code error;
  fs::create_directories(slurm.log_folder, error);
  if (error) return fail(Error{slurm.log_folder, 0, "", "cannot be made (" + error.message() + ")"});
  return std::make_unique<SlurmLauncher>(std::move(slurm));
}

}  // namespace fatmc::cli
