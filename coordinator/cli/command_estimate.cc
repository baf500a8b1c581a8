// fatmc estimate: frequency response matrix of a periodic record, with variances and interpolation bias.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "coordinator/cli/command.h"
#include "coordinator/cli/estimate_record.h"
#include "core/base/text.h"
#include "core/record/column_file.h"

namespace fatmc::cli {
namespace {

struct EstimateArguments {
  std::vector<std::string> records;
  std::string method = "lpm";
  EstimateOptions estimate;
  std::string directory;
};

std::string frm_csv(const EstimatedRecord& e) {
  std::string text = "line,frequency_hz,output,input,re,im,variance,bias\n";
  const auto name = [&](int column) { return e.record.names[static_cast<std::size_t>(column)]; };
  for (int k = 0; k < e.frm.line_count(); ++k) {
    const auto at = static_cast<std::size_t>(k);
    const std::string head = std::to_string(e.frm.lines[at]) + "," + shortest(e.frm.frequency_hz[at]) + ",";
    for (int i = 0; i < e.frm.n_out; ++i) {
      for (int j = 0; j < e.frm.n_in; ++j) {
        const std::complex<double> g = e.frm.G[k](i, j);
        text += head + name(e.record.output[static_cast<std::size_t>(i)]) + "," +
                name(e.record.input[static_cast<std::size_t>(j)]) + "," + shortest(g.real()) + "," +
                shortest(g.imag()) + "," + shortest(e.frm.variance(k, i, j)) + "," + shortest(e.bias[k](i, j)) + "\n";
      }
    }
  }
  return text;
}

std::string estimate_json(const EstimateArguments& arguments, const EstimatedRecord& e) {
  nlohmann::ordered_json json;
  json["method"] = arguments.method;
  json["indirect"] = e.frm.indirect;
  json["order"] = arguments.estimate.lpm.order;
  json["n_e"] = arguments.estimate.lpm.n_e;
  json["q"] = e.frm.q;
  json["n_transient"] = arguments.estimate.lpm.n_transient;
  json["q_noise"] = e.frm.q_noise;
  json["periods"] = e.record.periods;
  json["skipped_periods"] = arguments.estimate.skip_periods;
  json["period_samples"] = e.record.period_samples;
  json["rate_hz"] = e.record.rate_hz;
  json["lines"] = e.frm.lines;
  json["speed_factor"] = arguments.estimate.speed_correction ? nlohmann::ordered_json(e.speed_factor) : nullptr;
  std::vector<int> border;
  for (int k = 0; k < e.frm.line_count(); ++k) {
    const auto at = static_cast<std::size_t>(k);
    if (e.frm.border[at] != 0) border.push_back(e.frm.lines[at]);
  }
  json["border_lines"] = border;
  json["conventions"] = {
      {"line", "harmonic of one period; frequency_hz = line rate_hz / period_samples"},
      {"dft", "N^(-1/2) sum x[n] exp(-j 2 pi m n / N) over the whole record, N = periods period_samples"},
      {"transient", "polynomial of degree order through the n_transient nearest non-excited bins on each side, between "
                    "the first excited bin - (periods - 1) and the last + (periods - 1), shifted at the ends; taken off "
                    "outputs and inputs, not off references"},
      {"window", "2 n_e + 1 nearest excited lines, n_e on each side, shifted at the ends"},
      {"polynomial", "of degree order in the true frequency distance"},
      {"variance", "total variance E|G - G0|^2 of the element, B_jj C_V,ii; |G - G0|^2 / variance ~ F(2, 2q)"},
      {"bias", "|sum s_i (2 d_i / B_3dB)^E| |G|, E = order + 2 (order + 1 for odd orders), s the constant-term row of the "
               "least-squares polynomial at the offsets d_i, B_3dB = 2 sqrt((1 - 1/sqrt 2) |g0 / g2|) from the "
               "polynomial through the estimated element over the window, linear term dropped"}};
  return json.dump(2) + "\n";
}

/// The four largest local maxima of one element's magnitude, by frequency.
std::string peaks(const FrmEstimate& frm, int i, int j) {
  std::vector<std::pair<double, int>> found;
  const auto magnitude = [&](int k) { return std::abs(frm.G[k](i, j)); };
  for (int k = 1; k + 1 < frm.line_count(); ++k) {
    if (magnitude(k) > magnitude(k - 1) && magnitude(k) > magnitude(k + 1)) {
      found.emplace_back(magnitude(k), k);
    }
  }
  std::sort(found.rbegin(), found.rend());
  found.resize(std::min<std::size_t>(found.size(), 4));
  std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  std::vector<std::string> parts;
  for (const auto& [value, k] : found) {
    parts.push_back(significant(frm.frequency_hz[static_cast<std::size_t>(k)], 4) + " Hz (" + significant(value, 3) + ")");
  }
  return parts.empty() ? "none" : join(parts);
}

void print_summary(const EstimateArguments& arguments, const EstimatedRecord& e) {
  const FrmEstimate& frm = e.frm;
  print_estimate_head(arguments.estimate, e);
  for (int i = 0; i < frm.n_out; ++i) {
    for (int j = 0; j < frm.n_in; ++j) {
      std::printf("  %s/%s: highest peaks %s\n",
                  e.record.names[static_cast<std::size_t>(e.record.output[static_cast<std::size_t>(i)])].c_str(),
                  e.record.names[static_cast<std::size_t>(e.record.input[static_cast<std::size_t>(j)])].c_str(),
                  peaks(frm, i, j).c_str());
    }
  }
  int biased = 0;
  for (int k = 0; k < frm.line_count(); ++k) {
    biased += static_cast<int>((e.bias[k].array() > 0.1 * frm.G[k].array().abs()).count());
  }
  if (biased > 0) {
    const int smallest = ((arguments.estimate.lpm.order + 1) * frm.n_in + 1) / 2;
    std::printf("interpolation bias above 10 %% of the element at %d of %d points: a smaller --n-e follows peaks more "
                "closely, from %d on there is a variance\n",
                biased, frm.line_count() * frm.n_out * frm.n_in, smallest);
  }
  int outliers = 0;
  for (int k = 0; k < frm.line_count(); ++k) outliers += frm.outlier[k].cast<int>().sum();
  if (outliers > 0) std::printf("%d input values lie below 3 sigma of their noise: distrust those lines (5.2.2)\n", outliers);
  std::printf("written: %s/frm.csv, %s/estimate.json\n", arguments.directory.c_str(), arguments.directory.c_str());
}

Exit run_estimate(EstimateArguments& arguments) {
  if (arguments.records.size() != 1) {
    return report(Error{"", 0, "RECORD.csv", "estimate takes one record at a time so far, " +
                                                 std::to_string(arguments.records.size()) + " are named"});
  }
  if (arguments.method != "lpm") {
    return report(Error{"", 0, "--method", "\"" + arguments.method + "\" does not exist, there is: lpm"});
  }
  arguments.estimate.record = arguments.records.front();
  const Result<EstimatedRecord> result = estimate_record(arguments.estimate);
  if (!result) return report(result.error());
  std::filesystem::create_directories(arguments.directory);
  write_file_atomically(arguments.directory + "/frm.csv", frm_csv(*result));
  write_file_atomically(arguments.directory + "/estimate.json", estimate_json(arguments, *result));
  print_summary(arguments, *result);
  return Exit::done;
}

}  // namespace

void add_estimate_command(CLI::App& app, Exit& exit) {
  auto arguments = std::make_shared<EstimateArguments>();
  CLI::App* command = app.add_subcommand("estimate", "Frequency response matrix of a periodic record.");
  command->add_option("record", arguments->records, "RECORD.csv, its RECORD.toml beside it")->required();
  command->add_option("--method", arguments->method, "lpm: fast local polynomial method")->capture_default_str();
  add_estimate_options(*command, arguments->estimate);
  command->add_option("-o,--output", arguments->directory, "directory for frm.csv and estimate.json")->required();
  command->footer("Example: fatmc estimate flight.csv --n-e 9 --skip-periods 1 -o results/flight");
  command->callback([arguments, &exit] { exit = run_estimate(*arguments); });
}

}  // namespace fatmc::cli
