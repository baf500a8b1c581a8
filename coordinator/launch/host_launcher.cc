#include "coordinator/launch/host_launcher.h"

#include <poll.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <charconv>
#include <cstdio>

namespace fatmc {
namespace {

constexpr std::chrono::milliseconds kLongestPause{60'000};
constexpr int kWrongUse = 2;  // of fatmc-worker: it said why, and would say it again

Result<Host> parse_host(const std::string& text) {
  Host host{text, 1};
  const std::size_t colon = text.find(':');
  if (colon != std::string::npos) {
    host.name = text.substr(0, colon);
    const char* end = text.data() + text.size();
    const auto read = std::from_chars(text.data() + colon + 1, end, host.jobs);
    if (read.ec != std::errc() || read.ptr != end || host.jobs < 1 || host.jobs > 4096)
      return fail(Error{"", 0, "--hosts", "\"" + text + "\" has no number of jobs behind its colon"});
  }
  if (host.name.empty() || host.name.front() == '-')
    return fail(Error{"", 0, "--hosts", "\"" + text + "\" is no host, write for instance node1,node2:4"});
  return host;
}

}  // namespace

Result<std::vector<Host>> parse_hosts(const std::string& text) {
  std::vector<Host> hosts;
  for (std::size_t first = 0; first <= text.size();) {
    const std::size_t comma = std::min(text.find(',', first), text.size());
    const Result<Host> host = parse_host(text.substr(first, comma - first));
    if (!host) return fail(host.error());
    hosts.push_back(*host);
    first = comma + 1;
  }
  return hosts;
}

Result<std::string> fill_line(const std::string& line, const std::string& host, const std::string& command) {
  std::string out;
  bool has_host = false, has_command = false;
  for (std::size_t i = 0; i < line.size();) {
    if (line.compare(i, 6, "{host}") == 0) {
      out += shell_word(host);
      has_host = true;
      i += 6;
    } else if (line.compare(i, 9, "{command}") == 0) {
      out += shell_word(command);
      has_command = true;
      i += 9;
    } else {
      out += line[i++];
    }
  }
  if (!has_host || !has_command)
    return fail(Error{"", 0, "--launch-line",
                      "\"" + line + "\" does not say where {host} and {command} go, write both"});
  return out;
}

HostLauncher::HostLauncher(HostOptions options) : options_(std::move(options)) {
  for (const Host& host : options_.hosts) {
    slots_.emplace_back();
    slots_.back().host = host;
  }
}

void HostLauncher::start(Slot& slot) {
  RemoteWorker worker = options_.worker;
  worker.jobs = slot.host.jobs;
  const Result<std::string> line = fill_line(options_.line, slot.host.name, command_line(worker));
  if (!line) {
    failure_ = line.error().text();
    return;
  }
  spdlog::info("starting: {}", *line);
  slot.command->start({"/bin/sh", "-c", *line}, "", Time::max());
}

void HostLauncher::on_end(Slot& slot, const CommandResult& result, const LaunchView& view, Time now) {
  slot.ends = view.stored > slot.stored ? 1 : slot.ends + 1;
  slot.stored = view.stored;
  const std::string why =
      "exit code " + std::to_string(result.exit_code) + (result.errors.empty() ? "" : ": " + result.errors);
  spdlog::warn("the worker on {} ended: {}", slot.host.name, why);
  slot.given_up = result.exit_code == kWrongUse || slot.ends >= options_.ends_in_vain;
  const auto pause = options_.pause * (std::int64_t{1} << std::min(slot.ends - 1, 16U));
  slot.next = now + std::min<std::chrono::milliseconds>(pause, kLongestPause);
  if (!slot.given_up) return;
  std::fprintf(stderr, "fatmc: %s is given up: its worker ended (%s)\n", slot.host.name.c_str(), why.c_str());
  if (std::all_of(slots_.begin(), slots_.end(), [](const Slot& other) { return other.given_up; }))
    failure_ = "no host can run a worker, the last was " + slot.host.name + " (" + why + ")";
}

void HostLauncher::tick(const LaunchView& view, Time now) {
  for (Slot& slot : slots_) {
    if (slot.given_up || !failure_.empty()) continue;
    if (const auto result = slot.command->take(now)) on_end(slot, *result, view, now);
    if (!slot.command->running() && !slot.given_up && view.left > 0 && now >= slot.next) start(slot);
  }
}

void HostLauncher::stop(std::chrono::milliseconds patience) {
  const Time end = std::chrono::steady_clock::now() + patience;
  const auto running = [&] {
    const Time now = std::chrono::steady_clock::now();
    return std::any_of(slots_.begin(), slots_.end(),
                       [&](Slot& slot) { return slot.command->running() && !slot.command->take(now); });
  };
  while (running() && std::chrono::steady_clock::now() < end) ::poll(nullptr, 0, 5);
  slots_.clear();  // ends what is left of them here; a worker there ends when its coordinator is gone
}

}  // namespace fatmc
