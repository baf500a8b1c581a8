// fatmc query sensitivity: which drawn parameter drives a metric.
#include "coordinator/cli/command_sensitivity.h"

#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "coordinator/cli/database_use.h"
#include "coordinator/cli/sensitivity_table.h"
#include "core/base/text.h"

namespace fatmc::cli {
namespace {

struct SensitivityOptions {
  std::string database, format = "table";
  SensitivityRequest request;
};

std::string text_of(const std::optional<Estimate>& estimate, double factor, int decimals) {
  if (!estimate) return "-";
  return fixed(factor * estimate->value, decimals) + " (" + fixed(factor * estimate->interval.low, decimals) +
         " to " + fixed(factor * estimate->interval.high, decimals) + ")";
}

void print_table(const std::vector<SensitivityRow>& rows, const SensitivityRequest& request) {
  std::vector<std::vector<std::string>> lines = {
      {"cell", "metric", "parameter", "n", "rank correlation", "share of variance, %"}};
  for (const SensitivityRow& row : rows) {
    lines.push_back({row.cell, row.metric, row.parameter, std::to_string(row.n), text_of(row.rank, 1.0, 3),
                     text_of(row.share, 100.0, 1)});
  }
  std::vector<std::size_t> widths(lines[0].size(), 0);
  for (const auto& line : lines) {
    for (std::size_t i = 0; i < line.size(); ++i) widths[i] = std::max(widths[i], line[i].size());
  }
  for (const auto& line : lines) {
    std::string out;
    for (std::size_t i = 0; i < line.size(); ++i)
      out += line[i] + std::string(widths[i] - line[i].size() + 2, ' ');
    out.erase(out.find_last_not_of(' ') + 1);
    std::printf("%s\n", out.c_str());
  }
  std::printf(
      "intervals at %s %%: Fisher's z for the rank correlation, bootstrap over trials for the share\n",
      significant(100.0 * request.level, 4).c_str());
}

void print_csv(const std::vector<SensitivityRow>& rows) {
  std::printf("cell,metric,parameter,n,rank_correlation,rank_low,rank_high,share,share_low,share_high\n");
  const auto quoted = [](const std::string& text) {
    std::string out = "\"";
    for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
    return out + "\"";
  };
  const auto numbers = [](const std::optional<Estimate>& e) {
    if (!e) return std::string(",,");
    return shortest(e->value) + "," + shortest(e->interval.low) + "," + shortest(e->interval.high);
  };
  for (const SensitivityRow& row : rows) {
    std::printf("%s,%s,%s,%llu,%s,%s\n", quoted(row.cell).c_str(), quoted(row.metric).c_str(),
                quoted(row.parameter).c_str(), static_cast<unsigned long long>(row.n),
                numbers(row.rank).c_str(), numbers(row.share).c_str());
  }
}

void print_json(const std::vector<SensitivityRow>& rows) {
  nlohmann::ordered_json out = nlohmann::ordered_json::array();
  const auto add = [](nlohmann::ordered_json& row, const char* name, const std::optional<Estimate>& e) {
    const std::string key = name;
    row[key] = e ? nlohmann::ordered_json(e->value) : nullptr;
    row[key + "_low"] = e ? nlohmann::ordered_json(e->interval.low) : nullptr;
    row[key + "_high"] = e ? nlohmann::ordered_json(e->interval.high) : nullptr;
  };
  for (const SensitivityRow& row : rows) {
    nlohmann::ordered_json object = {
        {"cell", row.cell}, {"metric", row.metric}, {"parameter", row.parameter}, {"n", row.n}};
    add(object, "rank_correlation", row.rank);
    add(object, "share", row.share);
    out.push_back(std::move(object));
  }
  std::printf("%s\n", out.dump(1, ' ', false, nlohmann::json::error_handler_t::replace).c_str());
}

Exit run(const SensitivityOptions& options) {
  const Result<CampaignReader> reader = CampaignReader::open(options.database);
  if (!reader) return report(reader.error());
  const auto rows = sensitivity(*reader, options.request);
  if (!rows) return report(rows.error());
  if (options.format == "csv") {
    print_csv(*rows);
  } else if (options.format == "json") {
    print_json(*rows);
  } else {
    print_table(*rows, options.request);
  }
  return Exit::done;
}

}  // namespace

void add_sensitivity_command(CLI::App& query, Exit& exit) {
  auto options = std::make_shared<SensitivityOptions>();
  CLI::App* command = query.add_subcommand("sensitivity",
                                           "which drawn parameter drives a metric: rank correlations and "
                                           "first-order variance shares, with intervals");
  command->footer(
      "\"failed\" is a metric, too: 1 for a trial that is not ok.\n"
      "Example: fatmc query sensitivity results/coverage_dispersed.db --metric mean_speed_m_s");
  command->add_option("DB", options->database, "database of a campaign with [[dispersion]]")->required();
  command->add_option("--metric", options->request.metric, "this metric alone");
  command->add_option("--cell", options->request.cell, "this cell alone");
  command->add_option("--level", options->request.level, "of the intervals")
      ->check(CLI::Range(0.5, 0.9999))
      ->capture_default_str();
  command->add_option("--resamples", options->request.resamples, "of the bootstrap")
      ->check(CLI::Range(40, 100000))
      ->capture_default_str();
  command->add_option("--format", options->format, "layout")
      ->check(CLI::IsMember({"table", "csv", "json"}))
      ->capture_default_str();
  command->callback(
      [options, &exit] { exit = use_database(options->database, [&] { return run(*options); }); });
}

}  // namespace fatmc::cli
