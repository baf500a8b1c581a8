#include "campaigns/candidates/model_table.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "core/base/check.h"

namespace fatmc::candidates {
namespace {

tl::unexpected<Error> other_version(std::string_view name, const std::string& found) {
  return fail(Error{"", 0, std::string(name),
                    found +
                        ": another version of the study computed this database, run the spec into a new one "
                        "(fatmc run SPEC --db NEW.db)"});
}

/// `row` holds that many values of it.
Status check_array(const TrialRow& row, std::string_view name, std::size_t count) {
  const std::vector<double>* values = row.array(name);
  if (values == nullptr) return other_version(name, "the rows do not hold this list");
  if (values->size() == count) return {};
  return other_version(name, "a row holds " + std::to_string(values->size()) + " values where " +
                                 std::to_string(count) + " belong");
}

Status check_metrics(const TrialRow& row) {
  for (const std::string_view name : {kNotIdentified, kNotValidated, kNotContinuous}) {
    if (std::none_of(row.metrics.begin(), row.metrics.end(), [&](const auto& m) { return m.first == name; }))
      return other_version(name, "the rows do not hold this number");
  }
  return {};
}

/// All arrays of row_arrays.h, each as long as the models it lists need.
Status check_arrays(const TrialRow& row) {
  const std::vector<double>* past = row.array(kPast);
  const std::size_t models = past == nullptr ? 0 : past->size();
  for (const std::string_view name :
       {kPast, kFuture, kOrder, kState, kAgreement, kRms, kTheil, kNorm, kRollAgreement, kRollRms}) {
    if (Status status = check_array(row, name, models); !status) return status;
  }
  if (Status status = check_array(row, kOutputAgreement, models * kOutputs); !status) return status;
  const std::vector<double>* analysed = row.array(kAnalysed);
  if (analysed == nullptr) return check_array(row, kAnalysed, 0);
  std::size_t states = 0;
  for (const double index : *analysed) {
    FATMC_CHECK(index >= 0.0 && index < static_cast<double>(models), "an analysed model is one of the row's");
    states += static_cast<std::size_t>(array_of(row, kOrder)[static_cast<std::size_t>(index)]);
  }
  if (Status status = check_array(row, kMagnitude, analysed->size() * kFrequencies); !status) return status;
  if (Status status = check_array(row, kEigenvalues, 2 * states); !status) return status;
  if (Status status = check_array(row, kModalB, states * kInputs); !status) return status;
  return check_array(row, kModalC, states * kOutputs);
}

/// Takes modal models one after the other from the arrays of a row.
class ModelReader {
 public:
  explicit ModelReader(const TrialRow& row)
      : eigenvalues_(array_of(row, kEigenvalues)), b_(array_of(row, kModalB)), c_(array_of(row, kModalC)) {}

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
  const auto& analysed = array_of(row, kAnalysed);
  const auto& magnitude = array_of(row, kMagnitude);
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

std::vector<std::size_t> leading(const std::vector<std::size_t>& sorted, std::size_t count) {
  return {sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(std::min(count, sorted.size()))};
}

}  // namespace

Result<ModelTable> read_models(std::uint32_t cell, const RowSource& rows) {
  ModelTable out;
  Status status;
  rows(cell, [&](const TrialRow& row) {
    if (!status) return;
    ++out.trials;
    if (row.outcome != "ok") {
      ++out.failed_trials;
      return;
    }
    if (status = check_arrays(row); !status) return;
    if (status = check_metrics(row); !status) return;
    const std::size_t first = out.models.size();
    const auto value = [&](std::string_view name, std::size_t i) { return array_of(row, name)[i]; };
    const auto whole = [&](std::string_view name, std::size_t i) { return static_cast<int>(value(name, i)); };
    for (std::size_t i = 0; i < array_of(row, kPast).size(); ++i) {
      ModelRow model{whole(kPast, i), whole(kFuture, i), whole(kOrder, i),
                     static_cast<ModelState>(whole(kState, i))};
      model.agreement = value(kAgreement, i);
      model.rms = value(kRms, i);
      model.theil = value(kTheil, i);
      model.norm = value(kNorm, i);
      model.roll_agreement = value(kRollAgreement, i);
      model.roll_rms = value(kRollRms, i);
      for (std::size_t k = 0; k < kOutputs; ++k)
        model.output_agreement[k] = value(kOutputAgreement, i * kOutputs + k);
      out.models.push_back(model);
    }
    add_analyses(row, first, out);
    out.not_identified += metric_of(row, kNotIdentified);
    out.not_validated += metric_of(row, kNotValidated);
    out.not_continuous += metric_of(row, kNotContinuous);
  });
  if (!status) return fail(status.error());
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
