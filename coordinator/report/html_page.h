// A page that opens from disk: no script, no network, one style sheet for screen, phone, dark rooms and paper.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "campaigns/base/figure.h"

namespace fatmc::html {

/// Text between tags or in quotes: `&`, `<`, `>` and `"` as entities.
std::string text(std::string_view plain);

/// A name for `id` and `href`: lower-case letters and digits, all else one '-'.
std::string anchor(std::string_view name);

/// A figure with its caption; wider than the screen, it scrolls by itself. `id` is unique on the page.
std::string figure(const plot::Figure& figure, const std::string& id, std::string_view label,
                   std::string_view caption);

struct Column {
  std::string heading;
  bool numeric = false;  ///< aligned to the right
};
/// Cells are HTML already.
std::string table(const std::vector<Column>& columns, const std::vector<std::vector<std::string>>& rows);

/// The whole document around `body`.
std::string page(std::string_view title, const std::string& body);

}  // namespace fatmc::html
