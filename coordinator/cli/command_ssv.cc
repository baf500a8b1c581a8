// fatmc ssv: structured singular value of given loops, both bounds.
#include <cstdio>
#include <memory>
#include <system_error>

#include "coordinator/cli/command.h"
#include "coordinator/cli/output_path.h"
#include "coordinator/input/factor_file.h"
#include "core/base/text.h"
#include "core/record/column_file.h"
#include "core/robust/structured_singular_value.h"

namespace fatmc::cli {
namespace {

struct SsvArguments {
  std::string factors;
  std::string output;
};

Exit run_ssv(const SsvArguments& arguments) {
  if (Status status = check_output_file(arguments.output); !status) return report(status.error());
  const Result<std::vector<LoopFactors>> loops = read_loop_factors(arguments.factors);
  if (!loops) return report(loops.error());
  std::string text = "id,upper,lower,certified\n";
  int unconverged = 0;
  for (const LoopFactors& loop : *loops) {
    const SsvBounds bounds = structured_singular_value(loop.x, loop.radii);
    if (bounds.status == SsvStatus::not_converged) ++unconverged;
    text += loop.id + "," + shortest(bounds.upper) + "," + shortest(bounds.lower) + "," +
            (bounds.certified() ? "true" : "false") + "\n";
  }
  try {
    write_file_atomically(arguments.output, text);
  } catch (const std::system_error& e) {
    std::fprintf(stderr, "fatmc: %s: cannot be written: %s\n", arguments.output.c_str(), e.code().message().c_str());
    return Exit::failed;
  }
  if (unconverged > 0) {
    std::fprintf(stderr, "fatmc: %s: %d upper bounds may be above their optimum (they hold nevertheless)\n",
                 arguments.factors.c_str(), unconverged);
    return Exit::partial;
  }
  return Exit::done;
}

}  // namespace

void add_ssv_command(CLI::App& app, Exit& exit) {
  auto arguments = std::make_shared<SsvArguments>();
  CLI::App* command = app.add_subcommand(
      "ssv", "Upper and lower bound of the structured singular value of loops with a disc an element.");
  command
      ->add_option("factors", arguments->factors,
                   "CSV, a row a loop: id, X = (I + K G)^-1 K row by row (Xre11,Xim11,Xre12,..; n_in x n_out), radii of "
                   "G by column (w_out1_in1,w_out2_in1,..)")
      ->required();
  command->add_option("-o,--output", arguments->output, "CSV: id,upper,lower,certified (the bounds agree to 1e-8)")
      ->required();
  command->footer(
      "Example: fatmc ssv factors.csv -o ssv.csv\n"
      "  factors.csv: id,Xre11,Xim11,w_out1_in1\n"
      "               a,3,-4,0.5                   gives  a,2.5,2.5,true");
  command->callback([arguments, &exit] { exit = run_ssv(*arguments); });
}

}  // namespace fatmc::cli
