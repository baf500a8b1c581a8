#include "coordinator/state/precision_monitor.h"

#include "core/base/check.h"
#include "core/base/text.h"

namespace fatmc {

PrecisionMonitor::PrecisionMonitor(PrecisionRule rule, std::size_t cells) : rule_(std::move(rule)) {
  for (std::size_t i = 0; i < cells; ++i)
    cells_.push_back({ConfidenceSequence(rule_.sequence), 0, {}, false});
}

void PrecisionMonitor::add(const TrialRow& row) {
  FATMC_CHECK(row.key.cell < cells_.size(), "a cell of the plan");
  CellState& cell = cells_[row.key.cell];
  if (cell.ended || row.key.repetition < cell.trials) return;
  cell.waiting.emplace(row.key.repetition, rule_.value(row));
  advance(row.key.cell);
}

void PrecisionMonitor::advance(std::uint32_t index) {
  CellState& cell = cells_[index];
  const ConfidenceSequenceOptions& options = rule_.sequence;
  const bool bounded = options.kind == ConfidenceSequenceOptions::Kind::bernstein;
  while (!cell.ended && !cell.waiting.empty() && cell.waiting.begin()->first == cell.trials) {
    const std::optional<double> value = cell.waiting.begin()->second;
    cell.waiting.erase(cell.waiting.begin());
    ++cell.trials;
    if (!value) continue;
    if (bounded && (*value < options.low || *value > options.high)) {
      failure_ = rule_.metric + " is " + shortest(*value) + " in trial " + std::to_string(cell.trials - 1) +
                 " of cell " + std::to_string(index + 1) + ", outside its bounds [" + shortest(options.low) +
                 ", " + shortest(options.high) + "]: the cell runs to its last repetition";
      cell.ended = true;
      break;
    }
    cell.sequence.add(*value);
    if (!rule_.half_width || cell.sequence.count() < rule_.minimum) continue;
    if (cell.sequence.half_width() <= *rule_.half_width) {
      cell.ended = true;
      reached_.push_back({index, now(index)});
    }
  }
  if (cell.ended) cell.waiting.clear();
}

CellPrecision PrecisionMonitor::now(std::uint32_t index) const {
  const CellState& cell = cells_.at(index);
  return {cell.trials, cell.sequence.count(), cell.sequence.mean(), cell.sequence.interval()};
}

}  // namespace fatmc
