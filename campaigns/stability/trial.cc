#include "campaigns/stability/trial.h"

#include <utility>

#include "campaigns/base/decoder.h"
#include "campaigns/flown/flown_trials.h"
#include "campaigns/stability/row_arrays.h"
#include "core/stability/estimate_stability.h"

namespace fatmc::stability {
namespace {

class StabilityTrials final : public FlownTrials {
 public:
  StabilityTrials(std::unique_ptr<const FlownFlights> flown, NominalLoop nominal, StabilityOptions options)
      : FlownTrials(std::move(flown)), nominal_(std::move(nominal)), options_(options) {}

 private:
  void keep(const FrmEstimate& frm, const FlightRecord&, TrialRow& row) const override {
    row.arrays.emplace_back(kFrequency, frm.frequency_hz);
    for (const Reading& reading : kReadings) judge(frm, reading, row);
  }

  void judge(const FrmEstimate& frm, const Reading& reading, TrialRow& row) const {
    const MatrixStack<double> bias = interpolation_bias(flights().grid(), frm, reading.reading);
    StabilityOptions options = options_;
    options.bias = reading.bias;
    const EstimateStability judged = judge_estimate(frm, bias, nominal_, options);
    const auto add = [&](std::string name, const auto& value_of) {
      std::vector<double> values;
      for (int k = 0; k < frm.line_count(); ++k) values.push_back(value_of(k));
      row.arrays.emplace_back(std::move(name), std::move(values));
    };
    const auto line = [&](int k) -> const LineStability& {
      return judged.lines[static_cast<std::size_t>(k)];
    };
    if (&reading == &kMain) {
      add(std::string(kNominalHInfinity), [&](int k) { return line(k).h_infinity_nominal; });
      add(std::string(kNominalSsv), [&](int k) { return line(k).ssv_nominal; });
      row.arrays.emplace_back(kSmallestSnr, judged.snr_min_db);
      row.metrics.emplace_back(kBandHInfinity, judged.band.p_h_infinity);
      row.metrics.emplace_back(kBandSsv, judged.band.p_ssv);
      row.metrics.emplace_back(kTotalHInfinity, judged.band.p_total_h_infinity);
      row.metrics.emplace_back(kTotalSsv, judged.band.p_total_ssv);
      row.metrics.emplace_back(kMinimumSnr, options.minimum_snr_db);
      row.metrics.emplace_back(kLowSnrLines, judged.band.low_snr_lines);
    }
    // Only what combines the elements differs between the rules: the values are those already found.
    const auto bonferroni = [&](int k, double kappa) {
      if (line(k).status != JudgementStatus::ok) return 0.0;
      const EstimatedLine estimated = estimated_line(frm, bias, k);
      return line_confidence(kappa, estimated.sigma, systematic_error(estimated, options), frm.q,
                             CombinationRule::bonferroni);
    };
    using enum Criterion;
    add(value_array(reading, h_infinity), [&](int k) { return line(k).h_infinity; });
    add(value_array(reading, ssv), [&](int k) { return line(k).ssv.upper; });
    add(confidence_array(reading, h_infinity, Rule::min), [&](int k) { return line(k).p_h_infinity; });
    add(confidence_array(reading, ssv, Rule::min), [&](int k) { return line(k).p_ssv; });
    add(confidence_array(reading, h_infinity, Rule::bonferroni),
        [&](int k) { return bonferroni(k, line(k).kappa_h_infinity); });
    add(confidence_array(reading, ssv, Rule::bonferroni),
        [&](int k) { return bonferroni(k, line(k).kappa_ssv); });
  }

  NominalLoop nominal_;
  StabilityOptions options_;
};

Result<StabilityOptions> decode_options(const Tree& spec) {
  StabilityOptions options;
  options.combine = CombinationRule::min;
  const Tree* tree = spec.find("stability");
  if (tree == nullptr) return options;
  Decoder table(*tree, "stability");
  options.intergrid = table.real("intergrid", {.low = 0.0, .high = 1.0}, options.intergrid);
  options.minimum_snr_db =
      table.real("minimum_snr_db", {.low = -300.0, .high = 300.0}, options.minimum_snr_db);
  if (Status status = table.finish(); !status) return fail(status.error());
  return options;
}

// The nominal plant is the step map that flies, made stable (T 5.4), and its loop has to be stable: only then does a
// nominal value below 1 carry over to the estimate.
Result<NominalLoop> nominal_of(const FlownFlights& flights, const CampaignSpec& spec) {
  const LinearModel& sampled = flights.flight().sampled();
  const Tree* experiment = spec.tree.find("experiment");
  const auto broken = [&](std::string why) {
    return fail(Error{experiment->file, experiment->line, "experiment.controller.gain", std::move(why)});
  };
  const auto stable = stabilise({sampled.a, sampled.b, sampled.c, sampled.d});
  if (!stable) return broken("the linearised plant has no Schur form");
  const Eigen::MatrixXd controller = flights.flight().setup().gain.asDiagonal();
  const auto radius = closed_loop_radius(stable->model, controller);
  if (!radius || !(*radius < 1.0)) return broken("the nominal loop is not stable, take a smaller gain");
  std::vector<double> frequency_hz;
  for (int k = 0; k < flights.grid().line_count(); ++k)
    frequency_hz.push_back(flights.grid().frequency_hz(k));
  return nominal_loop(stable->model, controller, frequency_hz, flights.flight().setup().rate_hz);
}

Result<std::unique_ptr<PreparedCell>> prepare(const CampaignSpec& spec, std::uint32_t index) {
  static constexpr std::array kOwnTables = {"stability"};
  auto cell = decode_flown_cell(spec, index, kOwnTables);
  if (!cell) return fail(cell.error());
  auto options = decode_options(spec.tree);
  if (!options) return fail(options.error());
  auto flights = FlownFlights::prepare(spec, index, std::move(*cell));
  if (!flights) return fail(flights.error());
  auto nominal = nominal_of(**flights, spec);
  if (!nominal) return fail(nominal.error());
  return std::make_unique<StabilityTrials>(std::move(*flights), std::move(*nominal), *options);
}

}  // namespace

const TrialStudy kTrialStudy{"stability", &prepare};

}  // namespace fatmc::stability
