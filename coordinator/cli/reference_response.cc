#include "coordinator/cli/reference_response.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include "coordinator/input/nominal_plant_file.h"
#include "coordinator/input/response_file.h"

namespace fatmc::cli {

Result<ReferenceResponse> read_reference_response(const std::string& path, const EstimatedRecord& e) {
  const FrmEstimate& frm = e.response.frm;
  const std::vector<std::string> inputs = channel_names(e.record, e.record.input),
                                 outputs = channel_names(e.record, e.record.output);
  ReferenceResponse out;
  out.name = std::filesystem::path(path).filename().string();
  if (std::filesystem::path(path).extension() != ".csv") {
    // Without feedback: the model itself, which has to be stable to have a response.
    const Eigen::MatrixXd open = Eigen::MatrixXd::Zero(frm.n_in, frm.n_out);
    const Result<NominalPlant> plant =
        read_nominal_plant(path, {inputs, outputs, e.record.rate_hz, e.record.hold, open, frm.frequency_hz});
    if (!plant) return fail(plant.error());
    out.response = plant->loop.response;
    return out;
  }
  const Result<ResponseTable> table = read_response_table(path);
  if (!table) return fail(table.error());
  const auto response = matching_response(*table, outputs, inputs, path);
  if (!response) return fail(response.error());
  out.response.resize(frm.n_out, frm.n_in, frm.line_count());
  for (int k = 0; k < frm.line_count(); ++k) {
    out.response[k].setConstant(std::numeric_limits<double>::quiet_NaN());
    const double f = frm.frequency_hz[static_cast<std::size_t>(k)], slack = 1e-9 * f;
    const auto above = std::lower_bound(table->frequency_hz.begin(), table->frequency_hz.end(), f - slack);
    if (above == table->frequency_hz.end()) continue;
    const auto at = static_cast<int>(above - table->frequency_hz.begin());
    if (*above <= f + slack) {
      out.response[k] = (*response)[at];
    } else if (at > 0) {
      const double weight = (f - above[-1]) / (*above - above[-1]);
      out.response[k] = (1.0 - weight) * (*response)[at - 1] + weight * (*response)[at];
    }
  }
  return out;
}

}  // namespace fatmc::cli
