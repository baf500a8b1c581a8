// A figure as an SVG document of its own: no script, no font file, no other resource.
//
// Light and dark follow the reader's colour scheme (prefers-color-scheme). The same figure gives the same
// bytes.
#pragma once

#include <string>

#include "campaigns/base/figure.h"

namespace fatmc::plot {

std::string svg_of(const Figure& figure);

/// The same as a part of an HTML page that holds `svg_style()` once. `id`, unique on the page, begins the names that
/// the figure refers to; letters, digits and '-'.
std::string inline_svg(const Figure& figure, const std::string& id);

/// The style sheet of all figures.
std::string svg_style();

/// `&`, `<`, `>` and `"` as entities; control characters are left out.
std::string escaped(const std::string& text);

}  // namespace fatmc::plot
