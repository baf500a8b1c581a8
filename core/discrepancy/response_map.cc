#include "core/discrepancy/response_map.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/stats/empirical.h"

namespace fatmc {
namespace {

Eigen::Index element(int line, int output, int input) { return 9 * line + 3 * input + output; }

}  // namespace

Eigen::VectorXcd response_vector(FastLpm& estimator, const LoopRecord& record, bool closed_loop) {
  estimator.load(record.output, record.input);
  const FrmEstimate& frm = closed_loop
                               ? estimator.indirect(spectra_at_lines(estimator.grid(), record.reference))
                               : estimator.direct();
  Eigen::VectorXcd out(9 * frm.line_count());
  for (int k = 0; k < frm.line_count(); ++k) out.segment<9>(9 * k) = frm.G[k].reshaped();
  return out;
}

ResponseMap ResponseMap::layout_of(const LpmGrid& grid) {
  ResponseMap out;
  const int lines = grid.line_count();
  for (int k = 0; k < lines; ++k) out.frequency_hz_.push_back(grid.frequency_hz(k));
  const int bands = std::min(kBands, lines);
  for (int output = 0; output < 3; ++output) {
    for (int input = 0; input < 3; ++input) {
      for (int b = 0; b < bands; ++b)
        out.cells_.push_back({output, input, lines * b / bands, lines * (b + 1) / bands - 1});
    }
  }
  return out;
}

ResponseMap ResponseMap::fit(const LpmGrid& grid, const Eigen::Ref<const Eigen::MatrixXcd>& responses) {
  ResponseMap out = layout_of(grid);
  const Eigen::Index flights = responses.rows();
  out.mean_ = responses.colwise().mean().transpose();
  out.variance_ = (responses.rowwise() - out.mean_.transpose()).cwiseAbs2().colwise().sum().transpose() /
                  static_cast<double>(flights - 1);
  const auto cells = static_cast<Eigen::Index>(out.cells_.size());
  Eigen::MatrixXd values(flights, cells);
  for (Eigen::Index n = 0; n < flights; ++n)
    values.row(n) = out.statistics(responses.row(n).transpose()).transpose();
  out.centre_ = values.colwise().mean().transpose();
  const Eigen::MatrixXd centred = values.rowwise() - out.centre_.transpose();
  out.deviation_ =
      (centred.colwise().squaredNorm() / static_cast<double>(flights - 1)).cwiseSqrt().transpose();
  std::vector<double> largest;
  for (Eigen::Index n = 0; n < flights; ++n) {
    largest.push_back((centred.row(n).transpose().array() / out.deviation_.array().max(1e-12)).maxCoeff());
  }
  out.threshold_ = EmpiricalCdf(std::move(largest)).quantile(0.99);
  return out;
}

Eigen::VectorXd ResponseMap::statistics(const Eigen::Ref<const Eigen::VectorXcd>& response) const {
  Eigen::VectorXd out(static_cast<Eigen::Index>(cells_.size()));
  for (std::size_t c = 0; c < cells_.size(); ++c) {
    const MapCell& cell = cells_[c];
    double sum = 0.0;
    for (int k = cell.first; k <= cell.last; ++k) {
      const Eigen::Index at = element(k, cell.output, cell.input);
      sum += std::norm(response[at] - mean_[at]) / std::max(variance_[at], 1e-300);
    }
    out[static_cast<Eigen::Index>(c)] = sum / (cell.last - cell.first + 1);
  }
  return out;
}

std::vector<MapEntry> ResponseMap::read(const Eigen::Ref<const Eigen::VectorXcd>& response) const {
  const Eigen::VectorXd value = statistics(response);
  std::vector<MapEntry> out;
  for (std::size_t c = 0; c < cells_.size(); ++c) {
    const MapCell& cell = cells_[c];
    const auto at = static_cast<Eigen::Index>(c);
    double power = 0.0, model = 0.0;
    std::complex<double> product = 0.0;
    for (int k = cell.first; k <= cell.last; ++k) {
      const std::complex<double> g = response[element(k, cell.output, cell.input)];
      const std::complex<double> g0 = mean_[element(k, cell.output, cell.input)];
      power += std::norm(g);
      model += std::norm(g0);
      product += g * std::conj(g0);
    }
    MapEntry entry{cell, frequency_hz_[static_cast<std::size_t>(cell.first)],
                   frequency_hz_[static_cast<std::size_t>(cell.last)]};
    entry.decibel = 10.0 * std::log10(power / model);
    entry.degrees = std::arg(product) * 180.0 / std::numbers::pi;
    entry.sigma = std::sqrt(value[at]);
    entry.limit = std::sqrt(centre_[at] + threshold_ * std::max(deviation_[at], 1e-12));
    out.push_back(entry);
  }
  return out;
}

}  // namespace fatmc
