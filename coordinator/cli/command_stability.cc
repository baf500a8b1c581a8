// fatmc stability: how sure one record makes us that the loop it was measured in is stable.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "coordinator/cli/bias_choice.h"
#include "coordinator/cli/command.h"
#include "coordinator/cli/estimate_record.h"
#include "coordinator/cli/loop_controller.h"
#include "coordinator/cli/output_path.h"
#include "coordinator/input/nominal_plant_file.h"
#include "core/base/check.h"
#include "core/base/text.h"
#include "core/record/column_file.h"
#include "core/stability/estimate_stability.h"

namespace fatmc::cli {
namespace {

using Json = nlohmann::ordered_json;

struct StabilityArguments {
  EstimateOptions estimate;
  std::string nominal;
  std::string combine = "min";
  BiasChoice bias;
  StabilityOptions options;
  std::optional<double> gain;
  std::string directory;
};

struct JudgedRecord {
  EstimatedRecord estimated;
  NominalPlant nominal;
  EstimateStability stability;
};

Result<JudgedRecord> judge(const StabilityArguments& arguments) {
  if (!std::isfinite(arguments.options.intergrid) || arguments.options.intergrid < 0.0) {
    return fail(Error{"", 0, "--intergrid", "is a share of the magnitude, 0 or more, for instance 0.03"});
  }
  Result<EstimatedRecord> estimated = estimate_records(arguments.estimate, EstimationMethod::lpm);
  if (!estimated) return fail(estimated.error());
  const Record& record = estimated->record;
  const Result<Eigen::MatrixXd> controller =
      loop_controller(record, arguments.gain, arguments.estimate.records.front());
  if (!controller) return fail(controller.error());
  Result<NominalPlant> nominal = read_nominal_plant(
      arguments.nominal, {channel_names(record, record.input), channel_names(record, record.output),
                          record.rate_hz, record.hold, *controller, estimated->response.frm.frequency_hz});
  if (!nominal) return fail(nominal.error());
  // b is a share of |G|, which any correction of the estimate has reached already.
  if (arguments.bias.constant() != BiasConstant::exact_offsets) {
    FATMC_CHECK(estimated->response.grid.has_value(), "the fast LPM has a grid");
    estimated->response.bias =
        interpolation_bias(*estimated->response.grid, estimated->response.frm, arguments.bias.constant());
  }
  EstimateStability stability =
      judge_estimate(estimated->response.frm, estimated->response.bias, nominal->loop, arguments.options);
  return JudgedRecord{std::move(*estimated), std::move(*nominal), std::move(stability)};
}

std::string lines_csv(const JudgedRecord& judged) {
  const FrmEstimate& frm = judged.estimated.response.frm;
  std::string text =
      "line,frequency_hz,hinf_nominal,ssv_nominal,hinf,ssv_upper,ssv_lower,kappa_hinf,kappa_ssv,p_hinf,p_ssv,"
      "snr_min_db\n";
  for (std::size_t k = 0; k < judged.stability.lines.size(); ++k) {
    const LineStability& line = judged.stability.lines[k];
    text += std::to_string(frm.lines[k]);
    for (const double value :
         {frm.frequency_hz[k], line.h_infinity_nominal, line.ssv_nominal, line.h_infinity, line.ssv.upper,
          line.ssv.lower, line.kappa_h_infinity, line.kappa_ssv, line.p_h_infinity, line.p_ssv,
          judged.stability.snr_min_db[k]}) {
      text += "," + shortest(value);
    }
    text += "\n";
  }
  return text;
}

int certified_lines(const JudgedRecord& judged) {
  return static_cast<int>(std::count_if(judged.stability.lines.begin(), judged.stability.lines.end(),
                                        [](const LineStability& line) { return line.ssv.certified(); }));
}

std::string summary_json(const StabilityArguments& arguments, const JudgedRecord& judged) {
  const BandStability& band = judged.stability.band;
  const FrmEstimate& frm = judged.estimated.response.frm;
  const auto optional = [](const std::optional<double>& value) {
    return value ? Json(*value) : Json(nullptr);
  };
  Json json;
  json["nominal_stable"] = band.nominally_stable_ssv;
  json["p_band_hinf"] = band.p_h_infinity;
  json["p_band_ssv"] = band.p_ssv;
  json["p_total_hinf"] = band.p_total_h_infinity;
  json["p_total_ssv"] = band.p_total_ssv;
  json["combine"] = arguments.combine;
  json["bias"] = arguments.bias.text;
  json["intergrid"] = arguments.options.intergrid;
  json["nominal_stable_hinf"] = band.nominally_stable_h_infinity;
  json["minimum_snr_db"] = arguments.options.minimum_snr_db;
  json["low_snr_lines"] = band.low_snr_lines;
  json["failed_lines"] = band.failed_lines;
  json["certified_lines"] = certified_lines(judged);
  json["lines"] = frm.line_count();
  json["q"] = frm.q;
  const auto cover = intergrid_cover(frm.frequency_hz, arguments.options.intergrid);
  json["intergrid_covered_damping"] =
      cover && std::isfinite(cover->damping) ? Json(cover->damping) : Json(nullptr);
  json["nominal"] = {{"kind", judged.nominal.kind},
                     {"moved_poles", judged.nominal.moved_poles},
                     {"largest_pole", optional(judged.nominal.largest_pole)},
                     {"largest_closed_loop_pole", optional(judged.nominal.largest_closed_loop_pole)}};
  if (!judged.nominal.effects_not_shown.empty())
    json["nominal"]["effects_not_shown"] = judged.nominal.effects_not_shown;
  return json.dump(2) + "\n";
}

void print_nominal(const StabilityArguments& arguments, const NominalPlant& nominal) {
  std::printf("nominal model %s (%s): ", arguments.nominal.c_str(), nominal.kind.c_str());
  if (!nominal.largest_pole) {
    std::printf("a response, whose stability with K cannot be checked and is taken from you\n");
    return;
  }
  std::printf("stable, largest |z| %s, with K %s", fixed(*nominal.largest_pole, 7).c_str(),
              fixed(*nominal.largest_closed_loop_pole, 7).c_str());
  if (nominal.moved_poles > 0) {
    std::printf("; %d %s moved onto the circle 1 - 1e-8", nominal.moved_poles,
                nominal.moved_poles == 1 ? "pole" : "poles");
  }
  std::printf("\n");
  const std::string missing = effects_not_shown(nominal, arguments.nominal);
  if (!missing.empty()) std::printf("%s\n", missing.c_str());
}

/// "0.523 at 0.325 Hz" of the line where `value` is largest.
std::string worst(const JudgedRecord& judged, const std::function<double(const LineStability&)>& value,
                  double sign = 1.0) {
  const auto& lines = judged.stability.lines;
  const auto at = std::max_element(
      lines.begin(), lines.end(),
      [&](const LineStability& a, const LineStability& b) { return sign * value(a) < sign * value(b); });
  return significant(value(*at), 5) + " at " +
         significant(judged.estimated.response.frm.frequency_hz[static_cast<std::size_t>(at - lines.begin())],
                     4) +
         " Hz";
}

void print_row(const char* what, const std::string& h_infinity, const std::string& ssv) {
  std::printf("  %-34s %-22s %s\n", what, h_infinity.c_str(), ssv.c_str());
}

void print_gates(const StabilityArguments& arguments, const JudgedRecord& judged) {
  const EstimateStability& s = judged.stability;
  const std::vector<double>& f = judged.estimated.response.frm.frequency_hz;
  const auto above = [&s](auto value) {
    return std::count_if(s.lines.begin(), s.lines.end(),
                         [&](const auto& line) { return !(value(line) < 1.0); });
  };
  const auto nominal_h = above([](const LineStability& l) { return l.h_infinity_nominal; });
  const auto nominal_ssv = above([](const LineStability& l) { return l.ssv_nominal; });
  std::printf("gates: nominal value not below 1 on %td lines (H-infinity), %td (ssv): %s\n", nominal_h,
              nominal_ssv,
              s.band.nominally_stable_ssv ? "nominally stable" : "not shown to be nominally stable");
  const auto lowest = std::min_element(s.snr_min_db.begin(), s.snr_min_db.end());
  std::printf("       smallest input SNR %s dB at %s Hz, below %s dB on %d lines\n",
              fixed(*lowest, 1).c_str(),
              significant(f[static_cast<std::size_t>(lowest - s.snr_min_db.begin())], 4).c_str(),
              shortest(arguments.options.minimum_snr_db).c_str(), s.band.low_snr_lines);
  for (std::size_t k = 0; k < s.lines.size(); ++k) {
    if (s.lines[k].status == JudgementStatus::ok) continue;
    std::printf("       %d lines could not be judged and count as p = 0; the first at %s Hz: %s\n",
                s.band.failed_lines, significant(f[k], 4).c_str(), judgement_text(s.lines[k].status).c_str());
    break;
  }
  const auto hopeless =
      std::count_if(s.lines.begin(), s.lines.end(), [](const LineStability& l) { return l.p_ssv == 0.0; });
  if (hopeless > 0) {
    std::printf(
        "       p(ssv) is zero on %td %s: bias and intergrid error alone break the criterion there, whatever "
        "the "
        "noise (--bias off leaves the bias out)\n",
        hopeless, hopeless == 1 ? "line" : "lines");
  }
  const auto cover = intergrid_cover(f, arguments.options.intergrid);
  if (arguments.options.intergrid > 0.0 && cover) {
    std::printf(
        "       intergrid error %s %%: resonances between lines are covered from a damping of %s on (gap of "
        "%s Hz at "
        "%s Hz)\n",
        significant(100.0 * arguments.options.intergrid, 3).c_str(), significant(cover->damping, 2).c_str(),
        significant(cover->spacing_hz, 3).c_str(), significant(cover->frequency_hz, 3).c_str());
  }
}

void print_summary(const StabilityArguments& arguments, const JudgedRecord& judged) {
  const BandStability& band = judged.stability.band;
  print_estimate_head(arguments.estimate, judged.estimated);
  print_nominal(arguments, judged.nominal);
  std::printf("  %-34s %-22s %s\n", "", "H-infinity", "ssv");
  print_row("nominal, largest", worst(judged, [](const LineStability& l) { return l.h_infinity_nominal; }),
            worst(judged, [](const LineStability& l) { return l.ssv_nominal; }));
  print_row("robust, largest", worst(judged, [](const LineStability& l) { return l.h_infinity; }),
            worst(judged, [](const LineStability& l) { return l.ssv.upper; }));
  print_row("p of a line, smallest",
            worst(
                judged, [](const LineStability& l) { return l.p_h_infinity; }, -1.0),
            worst(
                judged, [](const LineStability& l) { return l.p_ssv; }, -1.0));
  print_row("p over the band", significant(band.p_h_infinity, 5), significant(band.p_ssv, 5));
  print_row("p over the band, gated (total)", significant(band.p_total_h_infinity, 5),
            significant(band.p_total_ssv, 5));
  print_gates(arguments, judged);
  std::printf("ssv: upper and lower bound agree to 1e-8 on %d of %zu lines\n", certified_lines(judged),
              judged.stability.lines.size());
  std::printf("elements combined by %s, bias %s\nwritten: %s/lines.csv, %s/summary.json\n",
              arguments.combine.c_str(), arguments.bias.text.c_str(), arguments.directory.c_str(),
              arguments.directory.c_str());
}

Exit run_stability(StabilityArguments& arguments) {
  if (Status status = check_output_directory(arguments.directory); !status) return report(status.error());
  arguments.options.combine = arguments.combine == "min" ? CombinationRule::min : CombinationRule::bonferroni;
  arguments.options.bias = arguments.bias.counted();
  const Result<JudgedRecord> judged = judge(arguments);
  if (!judged) return report(judged.error());
  const std::string lines = lines_csv(*judged), summary = summary_json(arguments, *judged);
  std::filesystem::create_directories(arguments.directory);
  write_file_atomically(arguments.directory + "/lines.csv", lines);
  write_file_atomically(arguments.directory + "/summary.json", summary);
  print_summary(arguments, *judged);
  return Exit::done;
}

}  // namespace

void add_stability_command(CLI::App& app, Exit& exit) {
  auto arguments = std::make_shared<StabilityArguments>();
  CLI::App* command = app.add_subcommand(
      "stability",
      "Confidence that the loop of a record is stable: H-infinity and structured singular value a line.");
  command
      ->add_option("record", arguments->estimate.records,
                   "RECORD.csv or RECORD.mat, its RECORD.toml beside it")
      ->required();
  command
      ->add_option("--nominal", arguments->nominal,
                   "MODEL known to be stable: TOML of kind aircraft, state_space or frf, or an frm.csv")
      ->required();
  command
      ->add_option("--combine", arguments->combine,
                   "over the elements of a line: min, the least p (2.271), or bonferroni, a bound on their "
                   "joint probability")
      ->check(CLI::IsMember({"min", "bonferroni"}))
      ->capture_default_str();
  add_bias_option(*command, arguments->bias);
  command
      ->add_option("--intergrid", arguments->options.intergrid,
                   "allowance for what lies between the lines, as a share of each element's magnitude")
      ->capture_default_str();
  command->add_option(
      "--gain", arguments->gain,
      "K is this times the identity in u = K (r - y); absent: controller_gain of the record's TOML");
  add_estimate_options(*command, arguments->estimate);
  command->add_option("-o,--output", arguments->directory, "directory for lines.csv and summary.json")
      ->required();
  command->footer(
      "Example: fatmc stability flight.csv --nominal campaigns/models/fat.toml -o results/stability\n"
      "docs/stability.md describes the method, the files and the keys of MODEL.");
  command->callback([arguments, &exit] { exit = run_stability(*arguments); });
}

}  // namespace fatmc::cli
