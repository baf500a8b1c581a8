#include "core/subspace/maneuvers.h"

#include <Eigen/QR>
#include <algorithm>
#include <string>

namespace fatmc {
namespace {

void take_off(Eigen::MatrixXd& channels, OffsetRemoval removal, Eigen::Ref<Eigen::RowVectorXd> offset) {
  if (removal == OffsetRemoval::none || channels.rows() == 0) {
    offset.setZero();
    return;
  }
  offset = removal == OffsetRemoval::mean ? Eigen::RowVectorXd(channels.colwise().mean()) : channels.row(0);
  channels.rowwise() -= Eigen::RowVectorXd(offset);
}

std::string channel_name(const char* kind, Eigen::Index index) {
  return std::string(kind) + " " + std::to_string(index + 1);
}

/// Largest deviation from its first value that a channel shows in any maneuver.
double excursion(std::span<const Maneuver> maneuvers, Eigen::MatrixXd Maneuver::*channels,
                 Eigen::Index index) {
  double largest = 0.0;
  for (const Maneuver& maneuver : maneuvers) {
    const auto column = (maneuver.*channels).col(index).array();
    largest = std::max(largest, (column - column(0)).abs().maxCoeff());
  }
  return largest;
}

Status check_shapes(std::span<const Maneuver> maneuvers) {
  const Maneuver& first = maneuvers.front();
  for (std::size_t j = 0; j < maneuvers.size(); ++j) {
    const Maneuver& maneuver = maneuvers[j];
    const std::string name = "maneuver " + std::to_string(j + 1);
    if (maneuver.inputs.cols() != first.inputs.cols() || maneuver.outputs.cols() != first.outputs.cols()) {
      return fail(name + " has " + std::to_string(maneuver.inputs.cols()) + " inputs and " +
                  std::to_string(maneuver.outputs.cols()) + " outputs, the first one " +
                  std::to_string(first.inputs.cols()) + " and " + std::to_string(first.outputs.cols()) +
                  ": give all the same channels");
    }
    if (maneuver.inputs.rows() != maneuver.outputs.rows() || maneuver.inputs.rows() == 0) {
      return fail(name + " has " + std::to_string(maneuver.inputs.rows()) + " samples of the inputs and " +
                  std::to_string(maneuver.outputs.rows()) + " of the outputs");
    }
    if (!maneuver.inputs.allFinite() || !maneuver.outputs.allFinite())
      return fail(name + " holds values that are not finite");
  }
  return {};
}

Status check_collinear_inputs(std::span<const Maneuver> maneuvers) {
  const Eigen::Index n_u = maneuvers.front().inputs.cols();
  Eigen::Index rows = 0;
  for (const Maneuver& maneuver : maneuvers) rows += maneuver.samples();
  if (rows < n_u) return fail("fewer samples than inputs");
  Eigen::MatrixXd all(rows, n_u);
  Eigen::Index row = 0;
  for (const Maneuver& maneuver : maneuvers) {
    all.middleRows(row, maneuver.samples()) = maneuver.inputs;
    row += maneuver.samples();
  }
  for (Eigen::Index c = 0; c < n_u; ++c) all.col(c).normalize();
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(all);
  qr.setThreshold(1e-10);
  if (qr.rank() == n_u) return {};
  const Eigen::Index dependent = qr.colsPermutation().indices()(n_u - 1);
  return fail(channel_name("input", dependent) +
              " is a linear combination of the others: leave it out, or add a maneuver that "
              "moves it by itself");
}

}  // namespace

Eigen::MatrixXd remove_offsets(std::span<Maneuver> maneuvers, OffsetRemoval removal) {
  if (maneuvers.empty()) return {};
  const Eigen::Index n_u = maneuvers.front().inputs.cols(), n_y = maneuvers.front().outputs.cols();
  Eigen::MatrixXd offsets(static_cast<Eigen::Index>(maneuvers.size()), n_u + n_y);
  Eigen::RowVectorXd row(n_u + n_y);
  for (std::size_t j = 0; j < maneuvers.size(); ++j) {
    take_off(maneuvers[j].inputs, removal, row.head(n_u));
    take_off(maneuvers[j].outputs, removal, row.tail(n_y));
    offsets.row(static_cast<Eigen::Index>(j)) = row;
  }
  return offsets;
}

int largest_past_window(std::span<const Maneuver> maneuvers) {
  if (maneuvers.empty()) return 0;
  Eigen::Index samples = 0;
  for (const Maneuver& maneuver : maneuvers) samples += maneuver.samples();
  const Eigen::Index n_z = maneuvers.front().inputs.cols() + maneuvers.front().outputs.cols();
  return static_cast<int>(samples / (n_z + static_cast<Eigen::Index>(maneuvers.size())));
}

Status check_maneuvers(std::span<const Maneuver> maneuvers) {
  if (maneuvers.empty()) return fail("no maneuver was given");
  const Maneuver& first = maneuvers.front();
  if (first.inputs.cols() == 0 || first.outputs.cols() == 0)
    return fail("at least one input and one output are needed");
  if (Status status = check_shapes(maneuvers); !status) return status;
  for (Eigen::Index i = 0; i < first.inputs.cols(); ++i) {
    if (excursion(maneuvers, &Maneuver::inputs, i) == 0.0)
      return fail(channel_name("input", i) + " never moves: leave it out");
  }
  for (Eigen::Index i = 0; i < first.outputs.cols(); ++i) {
    if (excursion(maneuvers, &Maneuver::outputs, i) == 0.0)
      return fail(channel_name("output", i) + " never moves: leave it out");
  }
  return check_collinear_inputs(maneuvers);
}

}  // namespace fatmc
