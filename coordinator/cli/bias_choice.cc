#include "coordinator/cli/bias_choice.h"

namespace fatmc::cli {

void add_bias_option(CLI::App& command, BiasChoice& choice) {
  command
      .add_option("--bias", choice.text,
                  "count the interpolation bias: on or offsets, with the constant of a line's actual offsets "
                  "(large at the ends of the band); constant, with (2.145)'s, one for all lines; off")
      ->check(CLI::IsMember({"on", "offsets", "constant", "off"}))
      ->capture_default_str();
}

}  // namespace fatmc::cli
