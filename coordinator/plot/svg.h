// A figure as an SVG document of its own: no script, no font file, no other resource.
//
// Light and dark follow the reader's colour scheme (prefers-color-scheme). The same figure gives the same
// bytes.
#pragma once

#include <string>

#include "campaigns/base/figure.h"

namespace fatmc::plot {

std::string svg_of(const Figure& figure);

}  // namespace fatmc::plot
