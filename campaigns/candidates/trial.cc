#include "campaigns/candidates/trial.h"

#include <algorithm>
#include <string>

#include "campaigns/candidates/candidates_spec.h"
#include "campaigns/candidates/flight_test.h"
#include "campaigns/candidates/model_analysis.h"
#include "campaigns/candidates/row_arrays.h"
#include "core/subspace/model_family.h"

namespace fatmc::candidates {
namespace {

/// Collects the arrays of a row, model by model.
class BlockResults {
 public:
  BlockResults(const CandidatesSpec& spec, std::span<const Maneuver> multisteps)
      : spec_(spec), multisteps_(multisteps) {}

  void add(const FamilyMember& member, const Result<PbsidModel>& model) {
    past_.push_back(member.past);
    future_.push_back(member.future);
    order_.push_back(member.order);
    state_.push_back(static_cast<double>(ModelState::ok));
    agreement_.push_back(0.0);
    rms_.push_back(0.0);
    theil_.push_back(0.0);
    output_agreement_.resize(output_agreement_.size() + kOutputs, 0.0);
    norm_.push_back(0.0);
    roll_agreement_.push_back(0.0);
    roll_rms_.push_back(0.0);
    if (lambda_past_ != member.past) {
      lambda_past_ = member.past;
      lambda_.push_back(0.0);
    }
    if (model) lambda_.back() = model->lambda;
    if (!model) return failed(ModelState::not_identified, member, model.error());
    norm_.back() = model->predictor_norm;
    const DiscreteModel discrete{model->a, model->b, model->c};
    const auto modal = modal_model(discrete);
    if (!modal) return failed(ModelState::not_validated, member, modal.error());
    const auto validation = validate(*modal, multisteps_, spec_.weights);
    if (!validation) return failed(ModelState::not_validated, member, validation.error());
    const OverallAccuracy& overall = validation->overall;
    agreement_.back() = overall.agreement;
    rms_.back() = overall.rms;
    theil_.back() = overall.theil;
    std::copy(overall.output_agreement.begin(), overall.output_agreement.end(),
              output_agreement_.end() - kOutputs);
    roll_agreement_.back() = validation->roll_agreement;
    roll_rms_.back() = validation->roll_rms;
    const bool selected = std::any_of(spec_.selections.begin(), spec_.selections.end(),
                                      [&](const Selection& s) { return s.order == member.order; });
    if (selected) add_analysis(discrete, *modal, member);
  }

  void write(TrialRow& row) {
    const int failures = not_identified_ + not_validated_ + not_continuous_;
    if (failures > 0)
      row.detail = std::to_string(failures) + " of " + std::to_string(past_.size()) + " models failed; " +
                   first_failure_;
    row.metrics = {{std::string(kModels), static_cast<double>(past_.size())},
                   {std::string(kNotIdentified), static_cast<double>(not_identified_)},
                   {std::string(kNotValidated), static_cast<double>(not_validated_)},
                   {std::string(kNotContinuous), static_cast<double>(not_continuous_)}};
    const auto array = [&](std::string_view name, std::vector<double>& values) {
      row.arrays.emplace_back(std::string(name), std::move(values));
    };
    array(kPast, past_), array(kFuture, future_), array(kOrder, order_), array(kState, state_);
    array(kAgreement, agreement_), array(kRms, rms_), array(kNorm, norm_), array(kLambda, lambda_);
    array(kTheil, theil_), array(kOutputAgreement, output_agreement_);
    array(kAnalysed, analysed_), array(kMagnitude, magnitude_);
    array(kRollAgreement, roll_agreement_), array(kRollRms, roll_rms_);
    array(kEigenvalues, eigenvalues_), array(kModalB, modal_b_), array(kModalC, modal_c_);
  }

 private:
  void failed(ModelState state, const FamilyMember& member, const Error& error) {
    state_.back() = static_cast<double>(state);
    (state == ModelState::not_identified ? not_identified_ : not_validated_) += 1;
    note(member, error);
  }

  void note(const FamilyMember& member, const Error& error) {
    if (!first_failure_.empty()) return;
    first_failure_ = "the first at p " + std::to_string(member.past) + ", f " +
                     std::to_string(member.future) + ", n " + std::to_string(member.order) + ": " +
                     error.message;
  }

  void add_analysis(const DiscreteModel& discrete, const ModalModel& modal, const FamilyMember& member) {
    const auto continuous = continuous_model(discrete, 1.0 / spec_.truth.rate_hz, Continuation::zoh);
    if (!continuous) {
      ++not_continuous_;
      return note(member, continuous.error());
    }
    analysed_.push_back(static_cast<double>(past_.size() - 1));
    const std::vector<double> magnitude_db = roll_magnitude_db(*continuous, study_frequencies());
    magnitude_.insert(magnitude_.end(), magnitude_db.begin(), magnitude_db.end());
    add_model(modal);
  }

  void add_model(const ModalModel& modal) {
    const auto add = [](std::vector<double>& to, const auto& matrix) {
      for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
        for (Eigen::Index j = 0; j < matrix.cols(); ++j) to.push_back(matrix(i, j));
      }
    };
    add(eigenvalues_, modal.eigenvalues.real());
    add(eigenvalues_, modal.eigenvalues.imag());
    add(modal_b_, modal.model.b);
    add(modal_c_, modal.model.c);
  }

  const CandidatesSpec& spec_;
  std::span<const Maneuver> multisteps_;
  std::vector<double> past_, future_, order_, state_, agreement_, rms_, theil_, output_agreement_, norm_,
      lambda_;
  std::vector<double> analysed_, magnitude_;
  std::vector<double> roll_agreement_, roll_rms_, eigenvalues_, modal_b_, modal_c_;
  int lambda_past_ = 0, not_identified_ = 0, not_validated_ = 0, not_continuous_ = 0;
  std::string first_failure_;
};

class CandidatesTrials final : public PreparedCell {
 public:
  CandidatesTrials(CandidatesSpec spec, FlownTest flown) : spec_(std::move(spec)), flown_(std::move(flown)) {}

  TrialRow run(std::uint64_t repetition) const override {
    TrialRow row;
    row.key = {0, repetition};
    const Identification& identification = spec_.identification;
    FamilyPlan plan;
    plan.pasts = identification.block_pasts(repetition);
    if (plan.pasts.empty()) {
      row.outcome = "no_block";
      row.detail = "the spec has " + std::to_string(identification.blocks()) + " blocks of past windows";
      return row;
    }
    plan.futures.assign(identification.pasts.rbegin(), identification.pasts.rend());  // f in M_p, H (3b)
    plan.lowest_order = identification.lowest_order;
    plan.highest_order = identification.highest_order;
    plan.regularization = identification.regularization;
    plan.lambda_for_each_past = identification.lambda_for_each_past;
    plan.final_regression = identification.final_regression;
    BlockResults results(spec_, flown_.multisteps);
    const Status status = identify_family(
        flown_.sweeps, plan,
        [&](const FamilyMember& member, const Result<PbsidModel>& model) { results.add(member, model); });
    if (!status) {
      row.outcome = "not_identified";
      row.detail = status.error().message;
      return row;
    }
    results.write(row);
    return row;
  }

 private:
  CandidatesSpec spec_;
  FlownTest flown_;
};

Result<std::unique_ptr<PreparedCell>> prepare(const CampaignSpec& spec, std::uint32_t cell) {
  auto decoded = decode_candidates(spec);
  if (!decoded) return fail(decoded.error());
  // One flight test for all blocks: that of repetition 0.
  FlownTest flown = recorded_test(decoded->truth, decoded->flight, spec.trial_seed({cell, 0}));
  if (Status status = check_maneuvers(flown.sweeps); !status) {
    Error error = status.error();
    const Tree* table = spec.tree.find("flight");
    error.file = table->file;
    error.line = table->line;
    error.key = "flight";
    return fail(error);
  }
  return std::make_unique<CandidatesTrials>(std::move(*decoded), std::move(flown));
}

}  // namespace

const TrialStudy kTrialStudy{"candidates", &prepare};

}  // namespace fatmc::candidates
