// `--bias` of the commands that judge stability: which reading of the interpolation bias they count.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "core/ident/interpolation_bias.h"

namespace fatmc::cli {

/// Of the text of the option: "on" and "offsets" are the constant of a line's actual offsets, "constant" is (2.145)'s, one
/// for all lines, "off" leaves the bias out.
struct BiasChoice {
  std::string text = "on";
  [[nodiscard]] bool counted() const { return text != "off"; }
  [[nodiscard]] BiasConstant constant() const {
    return text == "constant" ? BiasConstant::limit : BiasConstant::exact_offsets;
  }
};

void add_bias_option(CLI::App& command, BiasChoice& choice);

}  // namespace fatmc::cli
