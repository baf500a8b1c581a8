// A study for tests of the engine: cheap, deterministic, with every kind of outcome. No shipped program has
// it.
//
//   [[cell]]
//   name = "a"
//   repetitions = 100
//   work = 200000          # steps of a chaotic map, about 1 ns each
//   diverge_every = 10     # 0: never
//   array = 5              # length of the array of a row
//   crash_at = -1          # the repetition at which the process aborts
//   crash_every = 0        # every so many repetitions the process aborts; 0: never
//   crash_if = ""          # with crash_at: only while this file exists
//   hold_at = -1           # the repetition that waits while the file hold_while exists
//   hold_while = ""
//   last_while = ""        # the last repetition waits while this file exists
//   throw_at = -1          # the repetition at which the trial throws
//
//   [inputs]               # optional: metrics "linear" = 2 a + b + noise, "ishigami" of a, b and c, "noise"
//   a = 0.0
//   b = 0.0
//   c = 0.0
#include <unistd.h>

#include <array>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <stdexcept>
#include <thread>

#include "campaigns/base/decoder.h"
#include "campaigns/registry_summaries.h"
#include "campaigns/registry_trials.h"

namespace fatmc {
namespace {

using std::chrono::milliseconds;

// Says where it waits (FILE.PID) and waits while the file exists.
void hold(const std::string& file) {
  if (file.empty() || ::access(file.c_str(), F_OK) != 0) return;
  std::ofstream(file + "." + std::to_string(::getpid())) << "\n";
  while (::access(file.c_str(), F_OK) == 0) std::this_thread::sleep_for(milliseconds(2));
}

// What a process is told by its environment, so that workers of one campaign can differ.
double from_environment(const char* name, double otherwise) {
  const char* text = std::getenv(name);
  return text == nullptr ? otherwise : std::atof(text);
}

// FATMC_TEST_SLOWNESS: how many times longer a trial takes. Says that it is about to be slow (slow.PID).
void be_slow(std::chrono::steady_clock::duration taken) {
  const double slowness = from_environment("FATMC_TEST_SLOWNESS", 1.0);
  if (slowness <= 1.0) return;
  std::ofstream("slow." + std::to_string(::getpid())) << "\n";
  std::this_thread::sleep_for(
      std::chrono::duration<double>(std::chrono::duration<double>(taken) * (slowness - 1.0)));
}

class TestCell final : public PreparedCell {
 public:
  TestCell(const CampaignSpec& spec, std::uint32_t cell, Decoder& table) : spec_(spec), cell_(cell) {
    if (const Tree* inputs = spec.tree.find("inputs")) {
      respond_ = true;
      Decoder own(*inputs, "inputs");
      inputs_ = {own.real("a", {}, 0.0), own.real("b", {}, 0.0), own.real("c", {}, 0.0)};
      table.take(own.finish());
    }
    work_ = table.integer("work", {.low = 0, .high = 10'000'000'000}, 0);
    diverge_every_ = table.integer("diverge_every", {.low = 0}, 0);
    array_ = table.integer("array", {.low = 0, .high = 1'000'000}, 0);
    crash_at_ = table.integer("crash_at", {.low = -1}, -1);
    crash_every_ = table.integer("crash_every", {.low = 0}, 0);
    crash_if_ = table.text("crash_if", "");
    hold_at_ = table.integer("hold_at", {.low = -1}, -1);
    hold_while_ = table.text("hold_while", "");
    last_while_ = table.text("last_while", "");
    throw_at_ = table.integer("throw_at", {.low = -1}, -1);
  }

  [[nodiscard]] TrialRow run(std::uint64_t repetition) const override {
    const auto number = static_cast<std::int64_t>(repetition);
    if (number == crash_at_ && (crash_if_.empty() || ::access(crash_if_.c_str(), F_OK) == 0)) std::abort();
    if (crash_every_ > 0 && number % crash_every_ == 0) std::abort();
    if (number == throw_at_) throw std::runtime_error("as the spec told it");
    const auto begin = std::chrono::steady_clock::now();
    if (number == hold_at_) hold(hold_while_);
    if (repetition + 1 == spec_.cells[cell_].repetitions) hold(last_while_);
    RandomStream stream(spec_.trial_seed({cell_, repetition}), "test");
    double x = stream.uniform();
    for (std::int64_t i = 0; i < work_; ++i) x = 3.9 * x * (1.0 - x);  // the logistic map, chaotic at 3.9
    be_slow(std::chrono::steady_clock::now() - begin);
    TrialRow row;
    row.key = {cell_, repetition};
    if (diverge_every_ > 0 && number % diverge_every_ == diverge_every_ - 1) {
      row.outcome = "diverged";
      row.detail = "as the spec told it";
      return row;
    }
    // FATMC_TEST_WRONG_AT: a repetition whose result is another than elsewhere.
    if (number == static_cast<std::int64_t>(from_environment("FATMC_TEST_WRONG_AT", -1.0))) x += 1.0;
    row.metrics = {{"x", x}, {"normal", stream.normal()}};
    if (respond_) {
      const auto [a, b, c] = inputs_;
      const double noise = stream.normal();
      row.metrics.emplace_back("noise", noise);
      row.metrics.emplace_back("linear", 2.0 * a + b + noise);
      row.metrics.emplace_back(
          "ishigami", std::sin(a) + 7.0 * std::sin(b) * std::sin(b) + 0.1 * std::pow(c, 4) * std::sin(a));
    }
    std::vector<double> values(static_cast<std::size_t>(array_));
    for (double& value : values) value = stream.normal();
    row.arrays = {{"values", std::move(values)}};
    return row;
  }

 private:
  CampaignSpec spec_;
  std::uint32_t cell_;
  bool respond_ = false;
  std::array<double, 3> inputs_{};
  std::int64_t work_ = 0, diverge_every_ = 0, array_ = 0, crash_at_ = -1, crash_every_ = 0, hold_at_ = -1,
               throw_at_ = -1;
  std::string crash_if_, hold_while_, last_while_;
};

Result<std::unique_ptr<PreparedCell>> prepare(const CampaignSpec& spec, std::uint32_t cell) {
  Decoder table(spec.cells.at(cell).tree, "cell");
  table.skip("name");
  table.skip("repetitions");
  auto made = std::make_unique<TestCell>(spec, cell, table);
  if (Status status = table.finish(); !status) return fail(status.error());
  return made;
}

Result<std::vector<TableRow>> tables(const CampaignSpec& spec, const RowSource& rows) {
  std::vector<TableRow> out;
  for (std::uint32_t cell = 0; cell < spec.cells.size(); ++cell) {
    double sum = 0.0;
    std::uint64_t count = 0;
    rows(cell, [&](const TrialRow& row) {
      if (row.outcome != "ok") return;
      sum += row.metrics.at(1).second;
      ++count;
    });
    if (count == 0) continue;
    const auto n = static_cast<double>(count);
    out.push_back({"Section 1.2", spec.cells[cell].name, "mean of a standard normal", "1", 0.0, sum / n,
                   -2.0 / std::sqrt(n), 2.0 / std::sqrt(n), count, "shape", ""});
  }
  return out;
}

}  // namespace

const std::vector<TrialStudy>& trial_studies() {
  static const std::vector<TrialStudy> studies = {{"engine_test", prepare}};
  return studies;
}

const SummaryStudy* find_summary_study(std::string_view name) {
  static const SummaryStudy study = {"engine_test", tables};
  return name == study.name ? &study : nullptr;
}

}  // namespace fatmc
