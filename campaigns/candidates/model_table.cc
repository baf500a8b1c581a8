#include "campaigns/candidates/model_table.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "core/base/check.h"

namespace fatmc::candidates {
namespace {

const std::vector<double>& need(const TrialRow& row, std::string_view name) {
  const std::vector<double>* values = row.array(name);
  FATMC_CHECK(values != nullptr, "a row of the candidates study holds all its arrays");
  return *values;
}

/// Takes modal models one after the other from the arrays of a row.
class ModelReader {
 public:
  explicit ModelReader(const TrialRow& row)
      : eigenvalues_(need(row, kEigenvalues)), b_(need(row, kModalB)), c_(need(row, kModalC)) {}

  ModalModel next(Eigen::Index order) {
    ModalModel out;
    out.eigenvalues.resize(order);
    out.model.a = Eigen::MatrixXd::Zero(order, order);
    const double* parts = eigenvalues_.data() + 2 * states_;
    for (Eigen::Index i = 0; i < order; ++i) {
      out.eigenvalues(i) = {parts[i], parts[order + i]};
      out.model.a(i, i) = parts[i];
      // Columns of the basis are Re v, Im v of a pair: [re im; -im re].
      if (parts[order + i] > 0.0 && i + 1 < order) {
        out.model.a(i, i + 1) = parts[order + i];
        out.model.a(i + 1, i) = -parts[order + i];
      }
    }
    using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    out.model.b = Eigen::Map<const RowMajor>(b_.data() + states_ * kInputs, order, kInputs);
    out.model.c = Eigen::Map<const RowMajor>(c_.data() + states_ * kOutputs, kOutputs, order);
    states_ += order;
    return out;
  }

 private:
  const std::vector<double>&eigenvalues_, &b_, &c_;
  Eigen::Index states_ = 0;  // of the models before
};

void add_analyses(const TrialRow& row, std::size_t first, ModelTable& table) {
  const auto& analysed = need(row, kAnalysed);
  const auto& magnitude = need(row, kMagnitude);
  constexpr std::size_t grid = kFrequencies;
  ModelReader models(row);
  for (std::size_t k = 0; k < analysed.size(); ++k) {
    ModelAnalysisRow out;
    const auto begin = magnitude.begin() + static_cast<std::ptrdiff_t>(k * grid);
    out.magnitude_db.assign(begin, begin + static_cast<std::ptrdiff_t>(grid));
    ModelRow& model = table.models[first + static_cast<std::size_t>(analysed[k])];
    out.model = models.next(model.order);
    model.analysis = static_cast<int>(table.analyses.size());
    table.analyses.push_back(std::move(out));
  }
}

double metric(const TrialRow& row, std::string_view name) {
  for (const auto& [key, value] : row.metrics) {
    if (key == name) return value;
  }
  return 0.0;
}

std::vector<std::size_t> leading(const std::vector<std::size_t>& sorted, std::size_t count) {
  return {sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(std::min(count, sorted.size()))};
}

}  // namespace

ModelTable read_models(std::uint32_t cell, const RowSource& rows) {
  ModelTable out;
  rows(cell, [&](const TrialRow& row) {
    ++out.trials;
    if (row.outcome != "ok") {
      ++out.failed_trials;
      return;
    }
    const std::size_t first = out.models.size();
    const auto &past = need(row, kPast), &future = need(row, kFuture), &order = need(row, kOrder),
               &state = need(row, kState), &agreement = need(row, kAgreement), &rms = need(row, kRms),
               &norm = need(row, kNorm), &roll_agreement = need(row, kRollAgreement),
               &roll_rms = need(row, kRollRms);
    for (std::size_t i = 0; i < past.size(); ++i) {
      out.models.push_back({static_cast<int>(past[i]), static_cast<int>(future[i]),
                            static_cast<int>(order[i]), static_cast<ModelState>(static_cast<int>(state[i])),
                            agreement[i], rms[i], norm[i], roll_agreement[i], roll_rms[i], -1});
    }
    add_analyses(row, first, out);
    out.not_identified += metric(row, kNotIdentified);
    out.not_validated += metric(row, kNotValidated);
    out.not_continuous += metric(row, kNotContinuous);
  });
  return out;
}

Selected select(const ModelTable& table, const Selection& selection) {
  Selected out;
  std::size_t of_order = 0;
  for (std::size_t i = 0; i < table.models.size(); ++i) {
    const ModelRow& model = table.models[i];
    if (model.order != selection.order) continue;
    ++of_order;
    if (model.state == ModelState::ok) out.all.push_back(i);
  }
  // Equal d1 keep the order of the plan.
  std::stable_sort(out.all.begin(), out.all.end(), [&](std::size_t one, std::size_t other) {
    return table.models[one].agreement > table.models[other].agreement;
  });
  std::vector<double> norms;
  for (const std::size_t i : out.all) norms.push_back(table.models[i].norm);
  std::sort(norms.begin(), norms.end());
  const auto kept =
      static_cast<std::size_t>(std::lround(selection.smallest_norms * static_cast<double>(norms.size())));
  // Equal norms, of 0 by underflow for instance, are accepted together.
  const bool smallest = selection.smallest_norms > 0.0;
  out.limit = smallest ? (kept > 0 ? norms[kept - 1] : 0.0) : selection.norm;
  for (const std::size_t i : out.all) {
    const double norm = table.models[i].norm;
    if (smallest ? kept > 0 && norm <= out.limit : norm < out.limit) out.accepted.push_back(i);
  }
  const auto count = static_cast<std::size_t>(std::lround(selection.share * static_cast<double>(of_order)));
  out.best = leading(out.all, count);
  out.candidates = leading(out.accepted, count);
  return out;
}

}  // namespace fatmc::candidates
