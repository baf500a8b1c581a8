#include "coordinator/cli/diagnosis_files.h"

#include <nlohmann/json.hpp>
#include <sstream>

#include "campaigns/base/trial_row.h"
#include "core/base/text.h"

namespace fatmc::cli {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kMark = "# fatmc patch of parent ";

Json effect_json(const FoundEffect& found) {
  Json parameters = Json::array();
  for (const ParameterEstimate& p : found.parameters) {
    parameters.push_back(
        {{"name", p.name}, {"value", p.value}, {"low", p.low}, {"high", p.high}, {"unit", p.unit}});
  }
  return {{"id", found.effect.id},
          {"name", found.effect.name()},
          {"title", found.effect.kind().title},
          {"parameters", parameters},
          {"gain", found.gain}};
}

Json gap_json(const Gap& gap) { return {{"before", gap.before}, {"after", gap.after}, {"floor", gap.floor}}; }

Json measures_json(const GapMeasures& m) {
  return {{"cost", m.cost}, {"muad_share", m.muad_share}, {"theil", m.theil}, {"d1", m.agreement}};
}

std::vector<FoundEffect> all_effects(const DiagnosisPage& page) {
  std::vector<FoundEffect> out = page.earlier;
  out.insert(out.end(), page.diagnosis.effects.begin(), page.diagnosis.effects.end());
  return out;
}

std::string effect_tables(const DiagnosisPage& page) {
  std::string out;
  for (const FoundEffect& found : all_effects(page)) {
    out += "\n[[effect]]\nid = \"" + found.effect.id + "\"\n";
    for (const auto& [name, value] : found.effect.choices) out += name + " = \"" + value + "\"\n";
    for (const ParameterEstimate& p : found.parameters) {
      out += p.name + " = " + shortest(p.value) + "  # 95 %: " + significant(p.low, 5) + " to " +
             significant(p.high, 5) + (p.unit == "1" ? "" : " " + p.unit) + "\n";
    }
  }
  return out;
}

std::string data_hashes(const DiagnosisPage& page) {
  std::vector<std::string> hashes;
  for (const DiagnosedRecord* r : page.records) hashes.push_back("\"" + r->data_hash + "\"");
  return join(hashes);
}

}  // namespace

std::string diagnosis_json(const DiagnosisPage& page) {
  const Diagnosis& d = page.diagnosis;
  Json out;
  const bool added = !page.earlier.empty();
  out["verdict"] = added && d.verdict == Verdict::none ? name(Verdict::named) : name(d.verdict);
  out["effects"] = Json::array();
  for (const FoundEffect& found : all_effects(page)) out["effects"].push_back(effect_json(found));
  out["class"] = Json::array();
  for (const Effect& member : d.members) out["class"].push_back(member.name());
  out["separate_by"] = d.separate_by;
  out["where"] = Json::array();
  for (const Place& p : page.where) {
    out["where"].push_back({{"output", p.output},
                            {"input", p.input},
                            {"low_hz", p.low_hz},
                            {"high_hz", p.high_hz},
                            {"decibel", p.decibel},
                            {"degrees", p.degrees},
                            {"sigma", p.sigma}});
  }
  out["gap"] = {{"training", gap_json(d.training)}, {"holdout", gap_json(d.holdout)}};
  out["holdout"] = d.holdout_lines ? "every fifth line of the records" : "records";
  out["measures"] = Json::array();
  for (const MeasuredGap& gap : page.gaps) {
    out["measures"].push_back({{"record", gap.record},
                               {"holdout", gap.holdout},
                               {"before", measures_json(gap.before)},
                               {"after", measures_json(gap.after)},
                               {"floor", measures_json(gap.floor)}});
  }
  const Evidence& e = d.evidence;
  out["evidence"] = {
      {"scan", {{"value", e.scan}, {"left", e.scan_left}, {"threshold", page.thresholds.scan}}},
      {"energy",
       {{"value", e.energy},
        {"left", e.energy_left},
        {"threshold", page.thresholds.energy},
        {"floor", page.thresholds.energy_mean}}},
      {"local", {{"value", e.local}, {"left", e.local_left}, {"threshold", page.thresholds.local}}},
      {"level", {{"score", e.level}, {"limit", e.level_limit}}},
      {"leading", e.leading}};
  out["evidence"]["moments"] = Json::array();
  for (const MomentOutput& m : e.moments) {
    out["evidence"]["moments"].push_back({{"moment", m.moment}, {"value", m.value}, {"mean", m.mean}});
  }
  out["environment"] = Json::array();  // estimated beside the effects, never named
  for (const Effect& effect : d.environment) out["environment"].push_back(effect.text());
  out["notes"] = d.notes;
  return out.dump(2) + "\n";
}

std::string patch_toml(const DiagnosisPage& page) {
  std::string out =
      "# What the records show and the model lacks. Append it to the parent, or take model.toml.\nkind = "
      "\"patch\"\n";
  out += "parent = \"" + page.model->path + "\"\nparent_sha256 = \"" + hex(sha256(page.model->text)) + "\"\n";
  out += "data_sha256 = [" + data_hashes(page) + "]\nverdict = \"" +
         std::string(name(page.diagnosis.verdict)) + "\"\n";
  for (const FoundEffect& found : all_effects(page)) {
    out += "\n[[effect]]\nid = \"" + found.effect.id + "\"\n";
    for (const auto& [choice, value] : found.effect.choices) out += choice + " = \"" + value + "\"\n";
    for (const ParameterEstimate& p : found.parameters) out += p.name + " = " + shortest(p.value) + "\n";
    out += "[effect.interval]  # 95 %\n";
    for (const ParameterEstimate& p : found.parameters) {
      out += p.name + " = [" + shortest(p.low) + ", " + shortest(p.high) + "]\n";
    }
  }
  return out;
}

std::string patched_model(const DiagnosisPage& page) {
  std::string out = page.model->text;
  if (all_effects(page).empty()) return out;
  // The mark starts a line of its own without changing what stands before: a parent without a last newline keeps none.
  out += "\n" + std::string(kMark) + hex(sha256(page.model->text)) + "\n# data " + data_hashes(page) + "\n";
  return out + effect_tables(page);
}

std::vector<PatchBlock> patches_of(const std::string& text) {
  std::vector<PatchBlock> out;
  const std::string mark = "\n" + std::string(kMark);
  for (std::size_t at = text.find(mark); at != std::string::npos; at = text.find(mark, at + 1)) {
    PatchBlock block;
    block.begin = at;
    const std::size_t hash = at + mark.size();
    block.parent_hash = text.substr(hash, std::min<std::size_t>(64, text.find('\n', hash) - hash));
    block.whole = block.parent_hash == hex(sha256(std::string_view(text).substr(0, at)));
    const std::size_t end = std::min(text.find(mark, at + 1), text.size());
    std::stringstream body(text.substr(hash, end - hash));
    std::string line;
    std::getline(body, line);
    while (std::getline(body, line)) {
      if (!line.empty()) block.lines.push_back(line);
    }
    out.push_back(std::move(block));
  }
  return out;
}

}  // namespace fatmc::cli
