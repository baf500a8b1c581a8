// Addresses of values inside a spec: "model.mass.mass_kg", "experiment.controller.gain.2".
//
// Components are keys of tables, or numbers of list elements counted from 1 (as messages count them).
#pragma once

#include <array>
#include <string>
#include <string_view>

#include "campaigns/base/tree.h"
#include "core/base/error.h"

namespace fatmc {

/// The value at `path`, or null.
const Tree* find_at(const Tree& tree, std::string_view path);

/// Puts `value`, which keeps its own file and line, at `path` of `tree`. Tables on the way that are missing
/// are made: whether their keys are known is for the decoder of that table to say. The error stands at
/// `value` and names `path`: a list has no such element, or a component on the way is neither table nor list.
Status set_at(Tree& tree, std::string_view path, const Tree& value);

/// "mass_kg" of "model.mass.mass_kg".
std::string last_component(std::string_view path);

/// Whether it has components and none is empty.
bool is_path(std::string_view path);

/// Whether the engine itself reads what stands there (campaign, keep, stop, a cell's name ...), so that
/// neither a cell nor a draw can change it.
bool is_of_engine(std::string_view path);

/// Top-level tables that the engine reads and studies do not see.
inline constexpr std::array<std::string_view, 6> kEngineTables = {"dispersion", "factor", "keep",
                                                                  "size",       "stop",   "watch"};
/// Keys of a cell that the engine reads and studies do not see.
inline constexpr std::array<std::string_view, 3> kEngineCellKeys = {"disperse", "priority", "set"};

}  // namespace fatmc
