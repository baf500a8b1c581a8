// The library as text: what `fatmc simulate --effect list` and `--effect table` print.
#pragma once

#include <string>

namespace fatmc {

/// A line an effect and a line a parameter: ids, choices, units, nominal values, ranges.
std::string effect_listing();
/// The same as the table of docs/effects.md.
std::string effect_table_markdown();

}  // namespace fatmc
