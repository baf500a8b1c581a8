// fatmc select: candidate models of records, with their spread.
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "coordinator/cli/model_commands.h"
#include "coordinator/cli/output_path.h"
#include "coordinator/cli/record_candidates.h"
#include "coordinator/cli/regularization_option.h"
#include "coordinator/cli/state_space_file.h"
#include "core/base/text.h"
#include "core/record/column_file.h"

namespace fatmc::cli {
namespace {

using Json = nlohmann::ordered_json;

struct SelectOptions {
  CandidateArguments arguments;
  std::vector<int> pasts = {20, 10, 100}, orders = {4, 12};
  std::string regularization = "gcv", directory;
};

/// LOW:STEP:HIGH as a plan: windows descend for p, ascend for f.
Status make_plan(SelectOptions& options) {
  const int low = options.pasts[0], step = options.pasts[1], high = options.pasts[2];
  if (low < 1 || step < 1 || high < low)
    return fail(Error{"", 0, "--pasts",
                      "has to be LOW,STEP,HIGH with LOW and STEP of 1 at least, HIGH not below LOW"});
  if (options.orders[0] < 1 || options.orders[1] < options.orders[0])
    return fail(Error{"", 0, "--orders", "has to be LOW,HIGH with LOW of 1 at least, HIGH not below LOW"});
  FamilyPlan& plan = options.arguments.plan;
  for (int past = low; past <= high; past += step) plan.futures.push_back(past);
  plan.pasts.assign(plan.futures.rbegin(), plan.futures.rend());
  plan.lowest_order = options.orders[0];
  plan.highest_order = options.orders[1];
  return read_regularization(options.regularization, plan.regularization);
}

/// Of all orders the candidate with the highest d1; orders without candidates have none.
std::optional<std::size_t> best_candidate(const RecordCandidates& result) {
  std::optional<std::size_t> best;
  for (const OrderCandidates& order : result.orders) {
    if (order.selected.candidates.empty()) continue;
    const std::size_t first = order.selected.candidates.front();
    if (!best || result.table.models[first].agreement > result.table.models[*best].agreement) best = first;
  }
  return best;
}

Json candidates_json(const RecordCandidates& result) {
  Json json;
  json["inputs"] = result.inputs;
  json["outputs"] = result.outputs;
  json["rate_hz"] = result.rate_hz;
  json["models"] = result.table.models.size();
  json["first_failure"] = result.first_failure.empty() ? Json() : Json(result.first_failure);
  for (const OrderCandidates& order : result.orders) {
    Json entry = {{"order", order.order},
                  {"models", order.models},
                  {"failed", order.failed},
                  {"limit", std::isfinite(order.selected.limit) ? Json(order.selected.limit) : Json()},
                  {"accepted", order.selected.accepted.size()},
                  {"candidates", Json::array()},
                  {"unstable_candidates", order.unstable},
                  {"outputs", Json::array()}};
    for (const std::size_t i : order.selected.candidates) {
      const candidates::ModelRow& model = result.table.models[i];
      entry["candidates"].push_back({{"past", model.past},
                                     {"future", model.future},
                                     {"agreement", model.agreement},
                                     {"rms", model.rms},
                                     {"theil", model.theil},
                                     {"norm", model.norm}});
    }
    for (const SpreadScore& score : order.outputs) {
      entry["outputs"].push_back({{"output", score.output},
                                  {"best_variance_accounted_for", score.best_variance_accounted_for},
                                  {"median_variance_accounted_for", score.median_variance_accounted_for},
                                  {"error_rms", score.error_rms},
                                  {"spread_rms", score.spread_rms},
                                  {"covered_percent", score.covered}});
    }
    json["orders"].push_back(std::move(entry));
  }
  return json;
}

void print_orders(const RecordCandidates& result) {
  std::printf(
      "%zu models\n  n   failed  candidates  output   VAF %% best, median  rms error  rms spread  covered "
      "%%\n",
      result.table.models.size());
  for (const OrderCandidates& order : result.orders) {
    std::printf("  %-3d %6zu  %10zu", order.order, order.failed, order.selected.candidates.size());
    if (order.outputs.empty()) std::printf("\n");
    for (std::size_t i = 0; i < order.outputs.size(); ++i) {
      const SpreadScore& score = order.outputs[i];
      const auto percent = [](double value) {
        return value < -999.0 ? std::string("< -999") : fixed(value, 1);
      };
      std::printf("%s  %-8s %8s, %6s    %-9s  %-10s  %5s%s\n", i == 0 ? "" : "                        ",
                  score.output.c_str(), percent(score.best_variance_accounted_for).c_str(),
                  percent(score.median_variance_accounted_for).c_str(),
                  significant(score.error_rms, 3).c_str(), significant(score.spread_rms, 3).c_str(),
                  fixed(score.covered, 1).c_str(),
                  score.median_variance_accounted_for > 0.0 ? "" : "  not identified");
    }
    if (order.unstable > 0) std::printf("      %zu of the candidates are unstable\n", order.unstable);
  }
  if (!result.first_failure.empty()) std::printf("first failure: %s\n", result.first_failure.c_str());
}

Exit run_select(SelectOptions options) {
  if (Status status = make_plan(options); !status) return report(status.error());
  if (Status status = check_output_directory(options.directory); !status) return report(status.error());
  const auto result =
      record_candidates(options.arguments, [](int past) { std::fprintf(stderr, "past window %d\n", past); });
  if (!result) return report(result.error());
  std::filesystem::create_directories(options.directory);
  print_orders(*result);
  const std::optional<std::size_t> best = best_candidate(*result);
  write_file_atomically(options.directory + "/candidates.json", candidates_json(*result).dump(2) + "\n");
  if (!best) {
    std::printf("no candidate: raise --norm or --smallest-norms\nwritten: %s/candidates.json\n",
                options.directory.c_str());
    return Exit::failed;
  }
  const candidates::ModelRow& row = result->table.models[*best];
  const std::string name = "p " + std::to_string(row.past) + ", f " + std::to_string(row.future) + ", n " +
                           std::to_string(row.order);
  write_file_atomically(
      options.directory + "/model.toml",
      state_space_toml("best candidate, " + name + ", of fatmc select, offsets of the records removed",
                       result->rate_hz, result->inputs, result->outputs, result->models[*best]));
  std::printf("best candidate: %s, overall d1 %s\nwritten: %s/candidates.json, %s/model.toml\n", name.c_str(),
              significant(row.agreement, 3).c_str(), options.directory.c_str(), options.directory.c_str());
  return Exit::done;
}

}  // namespace

void add_select_command(CLI::App& app, Exit& exit) {
  auto options = std::make_shared<SelectOptions>();
  CLI::App* command = app.add_subcommand(
      "select", "candidate models of records: many windows and orders, their selection and spread");
  CandidateArguments& arguments = options->arguments;
  add_record_options(*command, arguments);
  command
      ->add_option("--pasts", options->pasts,
                   "LOW,STEP,HIGH: past windows; futures are the same up to each past")
      ->delimiter(',')
      ->expected(3)
      ->capture_default_str();
  command->add_option("--orders", options->orders, "LOW,HIGH")
      ->delimiter(',')
      ->expected(2)
      ->capture_default_str();
  command->add_option("--norm", arguments.norm, "limit of the norm of A_K^p (default: --smallest-norms)")
      ->check(CLI::PositiveNumber);
  command
      ->add_option("--smallest-norms", arguments.smallest_norms,
                   "share of the models of an order that pass by their norm")
      ->check(CLI::Range(1e-6, 1.0))
      ->capture_default_str();
  command
      ->add_option("--share", arguments.share,
                   "share of the models of an order that become candidates, best d1 first")
      ->check(CLI::Range(1e-6, 1.0))
      ->capture_default_str();
  command->add_option("--regularization", options->regularization, kRegularizationHelp)
      ->capture_default_str();
  command->add_option("-o,--output", options->directory, "directory for candidates.json and model.toml")
      ->required();
  command->footer(
      "Example: fatmc select flight.csv --decimate 5 --hold-back 0.4 --pasts 20,10,60 --orders 6,12 -o "
      "results/select");
  command->callback([options, &exit] { exit = run_select(*options); });
}

}  // namespace fatmc::cli
