// Numbers as text, the same in every locale.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace fatmc {

/// Shortest decimal text that reads back to the same double ("nan", "inf", "-inf" for the rest).
std::string shortest(double value);

/// `value` with `digits` significant digits, as "%.*g" in the C locale.
std::string significant(double value, int digits);

/// `value` with `decimals` digits after the point, as "%.*f" in the C locale.
std::string fixed(double value, int decimals);

/// The whole of `text` as a finite double, spaces around it allowed; false where it is not one.
bool parse_double(std::string_view text, double& value);

/// "a, b, c"
std::string join(const std::vector<std::string>& parts, std::string_view separator = ", ");

}  // namespace fatmc
