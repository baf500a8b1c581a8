#include "coordinator/cli/record_plausibility.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "core/base/text.h"

namespace fatmc::cli {
namespace {

using Vector = Eigen::VectorXd;

constexpr std::array<const char*, 3> kInput = {"xi_c", "eta_c", "zeta_c"};
constexpr double kDegrees = 57.29577951308232, kG = 9.80665;

double rms(const Vector& x) { return std::sqrt((x.array() - x.mean()).square().mean()); }

/// "57.3" or "9.81" where a ratio (or its inverse) is within `tolerance` of it.
std::optional<std::string> conversion(double ratio, double tolerance) {
  const double size = std::abs(std::log(std::abs(ratio)));
  if (std::abs(size - std::log(kDegrees)) < tolerance) return "57.3 (degrees for radians?)";
  if (std::abs(size - std::log(kG)) < tolerance) return "9.81 (g for m/s^2?)";
  return std::nullopt;
}

Status saturated(const Eigen::MatrixX3d& input, const std::string& file) {
  constexpr double kShare = 0.02;
  for (int i = 0; i < 3; ++i) {
    for (const double end : {input.col(i).maxCoeff(), input.col(i).minCoeff()}) {
      const auto n = (input.col(i).array() == end).count();
      if (static_cast<double>(n) > kShare * static_cast<double>(input.rows()) && n > 50) {
        return fail(Error{file, 0, kInput[static_cast<std::size_t>(i)],
                          "stands at its end, " + significant(end, 4) + ", in " + std::to_string(n) +
                              " samples: the logged command is saturated, fly a smaller reference"});
      }
    }
  }
  return {};
}

}  // namespace

Status check_plausible(const LoopRecord& record, const FlightSetup& setup, double rate_hz,
                       const std::string& file) {
  if (Status status = saturated(record.input, file); !status) return status;
  if (setup.closed_loop) {
    std::array<std::optional<std::string>, 3> off;
    for (int i = 0; i < 3; ++i) {
      const Vector e = record.reference.col(i) - record.output.col(i);
      const Vector centred = e.array() - e.mean();
      const double k = record.input.col(i).dot(centred) / centred.squaredNorm();
      if (setup.gain[i] != 0.0) off[static_cast<std::size_t>(i)] = conversion(k / setup.gain[i], 0.05);
    }
    if (off[0] && off[0] == off[1]) {  // the turn coordinator adds to the third
      return fail(Error{file, 0, "controller_gain",
                        "is off by " + *off[0] +
                            " from what the commands show of u = K (r - y): check the units of rates, "
                            "commands and gain"});
    }
  }
  if (record.has_attitude()) {
    const Eigen::Index n = record.attitude.rows();
    const Vector rate = (record.attitude.col(0).tail(n - 1) - record.attitude.col(0).head(n - 1)) * rate_hz;
    if (const auto off = conversion(rms(rate) / rms(record.output.col(0)), 0.2)) {
      return fail(Error{file, 0, "phi",
                        "changes at a rate that is off by " + *off + " from p: write both in rad and rad/s"});
    }
  }
  return {};
}

Status check_against_model(const LoopRecord& record, const ModelSimulator& model, const std::string& file) {
  auto flown = model.record({}, 0);
  if (!flown)
    return fail(Error{file, 0, "",
                      "the model does not survive the record's reference, check that it is in rad/s: " +
                          flown.error().message});
  std::array<std::optional<std::string>, 3> off;
  for (int i = 0; i < 3; ++i) {
    off[static_cast<std::size_t>(i)] = conversion(rms(record.output.col(i)) / rms(flown->output.col(i)), 0.3);
  }
  if (off[0] && off[0] == off[1] && off[0] == off[2]) {
    return fail(Error{
        file, 0, "output",
        "is off by " + *off[0] + " from what the model gives for this reference: write rates in rad/s"});
  }
  return {};
}

}  // namespace fatmc::cli
