#include "campaigns/base/dispersion.h"

#include <algorithm>
#include <cmath>

#include "campaigns/base/decoder.h"
#include "campaigns/base/spec_path.h"
#include "core/base/check.h"
#include "core/base/text.h"
#include "core/random/distributions.h"

namespace fatmc {
namespace {

using Law = Dispersion::Law;
using Apply = Dispersion::Apply;

const std::vector<std::string> kLaws = {"uniform", "normal", "truncated_normal", "log_normal",
                                        "multivariate_normal"};
const std::vector<std::string> kApplies = {"set", "add", "scale"};

void decode_names(Decoder& table, Dispersion& out) {
  const bool many = out.law == Law::multivariate_normal;
  out.paths = many ? table.texts("paths") : std::vector{table.text("path")};
  std::vector<std::string> names;
  for (const std::string& path : out.paths) {
    const char* key = many ? "paths" : "path";
    if (!is_path(path))
      table.reject(key, "\"" + path + "\" is no path, write one such as model.mass.mass_kg");
    if (is_of_engine(path)) table.reject(key, "\"" + path + "\" is no parameter of a trial");
    names.push_back(last_component(path));
  }
  out.names = many ? table.texts("names", names) : std::vector{table.text("name", names.front())};
  if (out.names.size() != out.paths.size()) {
    table.reject("names", "has " + std::to_string(out.names.size()) + " names for " +
                              std::to_string(out.paths.size()) + " paths, write a name a path");
  }
  for (const std::string& name : out.names) {
    if (name.empty()) table.reject(many ? "names" : "name", "is empty, write a name");
  }
}

void decode_interval(Decoder& table, Dispersion& out) {
  out.low = table.real("low");
  out.high = table.real("high");
  if (!(out.low < out.high)) table.reject("high", "is not above low, write a larger value");
}

void decode_multivariate(Decoder& table, Dispersion& out) {
  const std::size_t n = out.paths.size();
  if (n == 0) return table.reject("paths", "is empty, write a list of paths");
  out.centre = table.reals("mean", n);
  out.spread = table.reals("sd", n, {.low = 0.0});
  const auto correlation = table.matrix("correlation", n, n, {.low = -1.0, .high = 1.0});
  if (table.error()) return;
  out.factor = correlation_factor(correlation);
  if (out.factor.empty()) {
    table.reject("correlation",
                 "is no correlation matrix, write a symmetric positive semidefinite one with ones on "
                 "its diagonal");
  }
}

void decode_law(Decoder& table, Dispersion& out) {
  switch (out.law) {
    case Law::uniform:
      return decode_interval(table, out);
    case Law::normal:
      out.centre = {table.real("mean")};
      out.spread = {table.real("sd", {.low = 0.0})};
      return;
    case Law::truncated_normal:
      out.centre = {table.real("mean")};
      out.spread = {table.real("sd", {.low = 1e-300})};
      decode_interval(table, out);
      if (!table.error() && normal_probability(out.centre[0], out.spread[0], out.low, out.high) < 1e-12) {
        table.reject("low", "and high hold next to nothing of the normal law, write a wider interval");
      }
      return;
    case Law::log_normal:
      out.centre = {table.real("median", {.low = 1e-300})};
      out.spread = {table.real("log_sd", {.low = 0.0, .high = 100.0})};
      return;
    case Law::multivariate_normal:
      return decode_multivariate(table, out);
  }
}

Result<Dispersion> decode_one(const Tree& entry) {
  Decoder table(entry, "dispersion");
  Dispersion out;
  out.place = Tree{0.0, entry.file, entry.line};
  const auto index = [](const std::vector<std::string>& all, const std::string& one) {
    return std::find(all.begin(), all.end(), one) - all.begin();
  };
  const std::string law = table.choice("law", kLaws);
  const std::string apply = table.choice("apply", kApplies, "set");
  if (table.error()) return fail(*table.error());
  out.law = static_cast<Law>(index(kLaws, law));
  out.apply = static_cast<Apply>(index(kApplies, apply));
  decode_names(table, out);
  decode_law(table, out);
  const char* key = out.law == Law::multivariate_normal ? "paths" : "path";
  if (const Tree* path = entry.find(key)) out.place.line = path->line;
  if (Status status = table.finish(); !status) return fail(status.error());
  return out;
}

}  // namespace

std::vector<double> Dispersion::draw(const TrialSeed& trial) const {
  RandomStream stream(trial, "dispersion." + names.front());
  switch (law) {
    case Law::uniform:
      return {draw_uniform(stream, low, high)};
    case Law::normal:
      return {draw_normal(stream, centre[0], spread[0])};
    case Law::truncated_normal:
      return {draw_truncated_normal(stream, centre[0], spread[0], low, high)};
    case Law::log_normal:
      return {draw_log_normal(stream, centre[0], spread[0])};
    case Law::multivariate_normal:
      return draw_correlated(stream, centre, spread, factor);
  }
  FATMC_CHECK(false, "not a law");
}

std::vector<double> Dispersion::typical() const {
  if (law == Law::uniform) return {0.5 * low + 0.5 * high};
  if (law == Law::truncated_normal) return {std::clamp(centre[0], low, high)};
  return centre;
}

Result<std::vector<Dispersion>> decode_dispersions(const Tree& spec) {
  std::vector<Dispersion> out;
  Decoder top(spec, "");
  std::vector<std::string> names, paths;
  for (const Tree* entry : top.tables("dispersion", false)) {
    Result<Dispersion> one = decode_one(*entry);
    if (!one) return fail(one.error());
    for (std::size_t i = 0; i < one->names.size(); ++i) {
      const bool known = std::find(names.begin(), names.end(), one->names[i]) != names.end();
      if (known || std::find(paths.begin(), paths.end(), one->paths[i]) != paths.end()) {
        return fail(
            Error{one->place.file, one->place.line, known ? "dispersion.name" : "dispersion.path",
                  "\"" + (known ? one->names[i] : one->paths[i]) + "\" is dispersed twice, write another"});
      }
      names.push_back(one->names[i]);
      paths.push_back(one->paths[i]);
    }
    out.push_back(std::move(*one));
  }
  if (top.error()) return fail(*top.error());
  return out;
}

Status apply_draw(const Dispersion& dispersion, const std::vector<double>& values, Tree& tree) {
  FATMC_CHECK(values.size() == dispersion.paths.size(), "a value a path");
  for (std::size_t i = 0; i < values.size(); ++i) {
    Tree value = dispersion.place;
    value.value = values[i];
    if (dispersion.apply != Apply::set) {
      const Tree* nominal = find_at(tree, dispersion.paths[i]);
      const std::optional<double> number = nominal != nullptr ? real_value(*nominal) : std::nullopt;
      if (!number) {
        return fail(Error{value.file, value.line, "dispersion.path",
                          "\"" + dispersion.paths[i] + "\" holds no number to " +
                              kApplies[static_cast<std::size_t>(dispersion.apply)] +
                              ", write apply = \"set\""});
      }
      value.value = dispersion.apply == Apply::add ? *number + values[i] : *number * values[i];
    }
    if (Status status = set_at(tree, dispersion.paths[i], value); !status) return status;
  }
  return {};
}

}  // namespace fatmc
