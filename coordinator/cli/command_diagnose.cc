// fatmc diagnose: where model and records disagree, what is missing, and the model with it.
#include <cstdio>
#include <filesystem>
#include <memory>
#include <thread>

#include "coordinator/cli/command.h"
#include "coordinator/cli/diagnosis_files.h"
#include "coordinator/cli/diagnosis_report.h"
#include "coordinator/cli/diagnosis_run.h"
#include "coordinator/cli/output_path.h"
#include "coordinator/cli/response_diagnosis.h"
#include "coordinator/cli/response_model.h"
#include "core/base/text.h"
#include "core/record/column_file.h"

namespace fatmc::cli {
namespace {

namespace fs = std::filesystem;

struct Options {
  std::string model, output, undo, list;
  std::vector<std::string> records, holdout;
  DiagnosisRunOptions run;
};

std::string read_all(const std::string& path) { return read_file_bytes(path); }

Exit list_patches(const std::string& path) {
  const std::string text = read_all(path);
  if (text.empty()) return report(Error{path, 0, "", "is empty or cannot be read"});
  const std::vector<PatchBlock> patches = patches_of(text);
  if (patches.empty()) std::printf("%s carries no patch\n", path.c_str());
  for (std::size_t i = 0; i < patches.size(); ++i) {
    std::printf("patch %zu of parent %s%s\n", i + 1, patches[i].parent_hash.substr(0, 16).c_str(),
                patches[i].whole ? "" : " (what stands before it has been changed)");
    for (const std::string& line : patches[i].lines) std::printf("  %s\n", line.c_str());
  }
  return Exit::done;
}

Exit undo_patch(const std::string& path, const std::string& output) {
  const std::string text = read_all(path);
  const std::vector<PatchBlock> patches = patches_of(text);
  if (patches.empty()) return report(Error{path, 0, "", "carries no patch that could be undone"});
  if (!patches.back().whole) {
    return report(Error{
        path, 0, "",
        "was edited above its last patch: its parent is not what the patch was made for, edit it by hand"});
  }
  if (Status status = check_output_file(output); !status) return report(status.error());
  write_file_atomically(output, text.substr(0, patches.back().begin));
  std::printf("%s: %s without its last patch, SHA-256 %s\n", output.c_str(), path.c_str(),
              patches.back().parent_hash.c_str());
  return Exit::done;
}

void print_summary(const DiagnosisPage& page) {
  const Diagnosis& d = page.diagnosis;
  std::printf("verdict: %s\n", std::string(name(d.verdict)).c_str());
  const auto effect = [](const FoundEffect& f) {
    for (const ParameterEstimate& p : f.parameters) {
      std::printf("  %-40s %s = %s, 95 %% %s to %s%s\n", f.effect.name().c_str(), p.name.c_str(),
                  significant(p.value, 4).c_str(), significant(p.low, 4).c_str(),
                  significant(p.high, 4).c_str(), p.unit == "1" ? "" : (" " + p.unit).c_str());
    }
  };
  for (const FoundEffect& f : page.earlier) effect(f);
  for (const FoundEffect& f : d.effects) effect(f);
  if (!d.members.empty()) {
    std::printf("  these records cannot separate:\n");
    for (const Effect& m : d.members) std::printf("    %s\n", m.text().c_str());
    std::printf("  separated by: %s\n", d.separate_by.c_str());
  }
  std::printf("gap, whitened chi-square per feature (floor %s): training %s -> %s, held out%s %s -> %s\n",
              significant(d.training.floor, 3).c_str(), significant(d.training.before, 4).c_str(),
              significant(d.training.after, 4).c_str(), d.holdout_lines ? " (every fifth line)" : "",
              significant(d.holdout.before, 4).c_str(), significant(d.holdout.after, 4).c_str());
  const std::size_t most = 5;
  for (std::size_t i = 0; i < page.where.size() && i < most; ++i) {
    const Place& p = page.where[i];
    std::printf("  %s / %s, %s to %s Hz: %s dB, %s deg, %s sigma\n", p.output.c_str(), p.input.c_str(),
                significant(p.low_hz, 3).c_str(), significant(p.high_hz, 3).c_str(),
                significant(p.decibel, 3).c_str(), significant(p.degrees, 3).c_str(),
                significant(p.sigma, 3).c_str());
  }
  if (page.where.size() > most)
    std::printf("  and %zu places more, in the report\n", page.where.size() - most);
  for (const std::string& note : d.notes) std::printf("note: %s\n", note.c_str());
}

/// A row a candidate and size, the hardest to separate first; effects are quoted, since their texts hold commas.
std::string separability_csv(const std::vector<Separation>& separations) {
  std::string out = "effect,energy,nearest,angle_deg,left\n";
  for (const Separation& s : separations) {
    out += "\"" + s.effect.text() + "\"," + significant(s.energy, 4) + ",\"" + s.nearest.text() + "\"," +
           significant(s.angle_deg, 4) + "," + significant(s.left, 4) + "\n";
  }
  return out;
}

Exit diagnose_records(const Options& options) {
  if (options.model.empty() || options.records.empty()) {
    return report(
        Error{"", 0, options.model.empty() ? "--model" : "--record", "is needed, see fatmc diagnose --help"});
  }
  if (Status status = check_output_directory(options.output); !status) return report(status.error());
  if (!response_kind(options.model).empty()) {
    auto done = diagnose_response(options.model, options.records, options.holdout);
    if (!done) return report(done.error());
    fs::create_directories(options.output);
    for (const auto& [file, text] : done->files)
      write_file_atomically((fs::path(options.output) / file).string(), text);
    std::printf("%swritten: %s and what stands beside it\n", done->summary.c_str(),
                (fs::path(options.output) / "diagnosis.json").c_str());
    return Exit::done;
  }
  DiagnosisRunOptions run = options.run;
  if (run.cache.empty()) run.cache = fs::absolute(fs::path(options.output)).parent_path().string();
  auto done = run_diagnosis(options.model, options.records, options.holdout, run);
  if (!done) return report(done.error());
  fs::create_directories(options.output);
  const auto in = [&](const char* file) { return (fs::path(options.output) / file).string(); };
  write_file_atomically(in("report.html"), diagnosis_html(done->page, done->overlays, done->map));
  write_file_atomically(in("model.toml"), patched_model(done->page));
  write_file_atomically(in("patch.toml"), patch_toml(done->page));
  write_file_atomically(in("diagnosis.json"), diagnosis_json(done->page));
  if (run.separability) write_file_atomically(in("separability.csv"), separability_csv(done->separations));
  print_summary(done->page);
  std::printf("written: %s, patch.toml, model.toml, report.html\n", in("diagnosis.json").c_str());
  return Exit::done;
}

Exit run(const Options& options) {
  if (!options.list.empty()) return list_patches(options.list);
  if (options.output.empty()) return report(Error{"", 0, "-o", "is needed, see fatmc diagnose --help"});
  if (!options.undo.empty()) return undo_patch(options.undo, options.output);
  return diagnose_records(options);
}

}  // namespace

void add_diagnose_command(CLI::App& app, Exit& exit) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand(
      "diagnose", "find where records and model disagree, name what is missing, add it to the model");
  command->add_option("--model", options->model, "aircraft (TOML), earlier patches included; or kind state_space, frf, recorded_output");
  command->add_option("--record", options->records,
                      "records of the loop (CSV with TOML beside it); several at other levels or speeds");
  command->add_option("--holdout", options->holdout,
                      "records that take no part in the fit; none: every fifth line is held back");
  command->add_flag("--until-consistent", options->run.until_consistent,
                    "go on with the patched model until nothing is left to name");
  command->add_flag("--separability", options->run.separability,
                    "also write DIR/separability.csv: how far each effect is from the nearest other one");
  command->add_option("--exclude", options->run.excluded, "effects that are no candidates, by id")
      ->delimiter(',');
  command->add_option("--flights", options->run.flights, "flights of the model behind the law of chance")
      ->check(CLI::Range(200, 100000))
      ->capture_default_str();
  command
      ->add_option("--threads", options->run.threads,
                   "0: as many as the machine has; results do not depend on it")
      ->check(CLI::Range(0, 1024));
  command->add_option("--cache", options->run.cache,
                      "folder for what depends on model and experiment alone; default: beside DIR");
  command->add_option("--list", options->list, "MODEL: lists its patches and does nothing else");
  command->add_option("--undo", options->undo, "MODEL: writes it without its last patch to -o FILE");
  command->add_option("-o,--output", options->output,
                      "DIR for diagnosis.json, patch.toml, model.toml, report.html");
  command->footer(
      "Example: fatmc diagnose --model campaigns/models/fat.toml --record results/flight.csv -o "
      "results/diagnosis");
  command->callback([options, &exit] { exit = run(*options); });
}

}  // namespace fatmc::cli
