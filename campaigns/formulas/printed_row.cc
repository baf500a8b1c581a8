#include "campaigns/formulas/printed_row.h"

#include <cmath>
#include <limits>

namespace fatmc::formulas {

double in_last_digits(const Printed& printed, double value) {
  if (printed.value == 0.0) return value;
  return value / std::pow(10.0, std::floor(std::log10(std::abs(printed.value))) + 1 - printed.digits);
}

TableRow& add_printed(std::vector<TableRow>& rows, const std::string& table, const std::string& row,
                      const std::string& quantity, const std::string& unit, const Printed& printed,
                      double value, const std::string& otherwise) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  TableRow out{table, row, quantity, unit, printed.value, value, kNone, kNone, 0, "differs", otherwise};
  const double ours = in_last_digits(printed, value);
  const double theirs = std::round(in_last_digits(printed, printed.value));
  if (std::round(ours) == theirs) {
    out.verdict = "exact";
    out.why.clear();
  } else if (std::trunc(ours) == theirs) {
    out.verdict = "exact";
    out.why = "the printed figure is cut off, not rounded";
  }
  rows.push_back(std::move(out));
  return rows.back();
}

void judge_bound(TableRow& row, bool below, const std::string& otherwise) {
  const bool holds = below ? row.value < row.published : row.value > row.published;
  row.verdict = holds ? "exact" : "differs";
  row.why = below ? "printed is a bound, less than" : "printed is a bound, more than";
  if (!holds) row.why += "; " + otherwise;
}

void same_order_is_shape(TableRow& row) {
  if (row.verdict != "differs") return;
  const double ratio = row.value / row.published;
  if (ratio > 0.0 && std::abs(std::log10(ratio)) <= 0.5) row.verdict = "shape";
}

}  // namespace fatmc::formulas
