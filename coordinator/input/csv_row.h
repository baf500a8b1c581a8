// Fields of one row of a CSV that holds more than numbers.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace fatmc {

/// The fields between commas, blanks around them left out.
std::vector<std::string> split_csv_row(std::string_view line);

}  // namespace fatmc
