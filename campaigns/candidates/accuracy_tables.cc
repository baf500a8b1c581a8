// Tables of counts and of accuracy by order: H 3.3, 4.1 and Fig. 4.
#include <algorithm>
#include <map>
#include <set>

#include "campaigns/candidates/cell_tables.h"
#include "core/base/text.h"
#include "core/stats/empirical.h"
#include "core/subspace/model_fit.h"

namespace fatmc::candidates {
namespace {

void add_counts(const ModelTable& table, const CellTables& out) {
  const auto n = static_cast<std::uint64_t>(table.models.size());
  const auto add = [&](const char* name, double value) {
    out.add(out.row("Models", name, "number", "", value, table.trials));
  };
  add("identified and validated or failed", static_cast<double>(n));
  add("not identified", table.not_identified);
  add("not validated", table.not_validated);
  add("without a continuous model (orders selected from)", table.not_continuous);
  if (table.failed_trials > 0) add("blocks that failed whole", static_cast<double>(table.failed_trials));
}

/// Models of one order that were validated.
struct OrderAccuracy {
  std::vector<double> agreement, rms, theil;
};

std::map<int, OrderAccuracy> by_order(const ModelTable& table) {
  std::map<int, OrderAccuracy> out;
  for (const ModelRow& model : table.models) {
    if (model.state != ModelState::ok) continue;
    OrderAccuracy& order = out[model.order];
    order.agreement.push_back(model.agreement);
    order.rms.push_back(model.rms);
    order.theil.push_back(model.theil);
  }
  return out;
}

double quantile(std::vector<double> values, double p) { return sample_quantile(values, p); }

void add_order(int order, const OrderAccuracy& accuracy, const CellTables& out) {
  const EmpiricalCdf cdf(accuracy.agreement);
  const std::string name = "n = " + std::to_string(order);
  const std::uint64_t n = accuracy.agreement.size();
  const std::pair<const char*, double> quantiles[] = {{"smallest d1", 0.0},
                                                      {"lower quartile", 0.25},
                                                      {"median", 0.5},
                                                      {"upper quartile", 0.75},
                                                      {"largest d1", 1.0}};
  for (const auto& [quantity, p] : quantiles)
    out.add(out.row("Fig. 4", name, quantity, "", cdf.quantile(p), n));
  out.add(out.row("Fig. 4", name, "share of adequate models (d1 from 0.80)", "%",
                  100.0 * (1.0 - cdf(0.8 - 1e-12)), n));
  out.add(out.row("Fig. 4", name, "share of adequate models (J_rms up to 3.5)", "%",
                  100.0 * EmpiricalCdf(accuracy.rms)(3.5), n));
  TableRow rms = out.row("Fig. 4", name, "median J_rms", "ft/s, deg/s, deg", quantile(accuracy.rms, 0.5), n);
  rms.why = "rated " + std::string(rms_rating(rms.value)) + " by (9)";
  out.add(std::move(rms));
  out.add(out.row("Fig. 4", name, "median Theil coefficient", "", quantile(accuracy.theil, 0.5), n));
}

/// What H 4.1 says of the models of all orders.
void add_order_claims(const std::map<int, OrderAccuracy>& orders, const CellTables& out) {
  const char* name = "all orders";
  std::uint64_t adequate = 0, all = 0;
  int best = 0;
  double largest = -1.0;
  for (const auto& [order, accuracy] : orders) {
    for (const double d1 : accuracy.agreement) {
      ++all;
      adequate += d1 >= 0.8 ? 1 : 0;
      if (d1 > largest) largest = d1, best = order;
    }
  }
  TableRow majority =
      out.claim("Fig. 4", name, "adequate models (print: the majority)", "%", kNone, all, 50.0);
  fill_share(majority, adequate, all, all);
  majority.why = kRelatedModels;
  // A majority or none: near it is no virtue.
  out.add_claim(std::move(majority), 2 * adequate > all, "the noise was chosen before any model was judged");
  out.add_claim(out.claim("Fig. 4", name, "order of the largest d1 (print: above 15)", "", best, all, 15.0),
                best > 15, "one flight test: no interval");
  const auto change = [&](const char* quantity, double p, bool rises) {
    const double difference =
        quantile(orders.rbegin()->second.agreement, p) - quantile(orders.begin()->second.agreement, p);
    out.add_claim(out.claim("Fig. 4", name, quantity, "", difference, all, 0.0),
                  rises ? difference > 0.0 : difference < 0.0, "one flight test: no interval");
  };
  change("median d1, highest order less lowest (print: rises)", 0.5, true);
  change("largest d1, highest order less lowest (print: rises)", 1.0, true);
  change("smallest d1, highest order less lowest (print: falls)", 0.0, false);
}

/// d1 of each output, which the overall d1 hides.
void add_outputs(const ModelTable& table, int order, const CellTables& out) {
  for (std::size_t k = 0; k < kOutputs; ++k) {
    std::vector<double> values;
    for (const ModelRow& model : table.models) {
      if (model.order == order && model.state == ModelState::ok) values.push_back(model.output_agreement[k]);
    }
    if (values.empty()) return;
    out.add(out.row("Validation", "n = " + std::to_string(order), "median d1 of " + output_names()[k], "",
                    quantile(values, 0.5), values.size()));
  }
}

}  // namespace

void add_accuracy_tables(const ModelTable& table, const std::vector<Selection>& selections,
                         const CellTables& out) {
  add_counts(table, out);
  const auto orders = by_order(table);
  for (const auto& [order, accuracy] : orders) add_order(order, accuracy, out);
  if (!orders.empty()) add_order_claims(orders, out);
  std::set<int> selected;
  for (const Selection& selection : selections) selected.insert(selection.order);
  for (const int order : selected) add_outputs(table, order, out);
}

void add_roll_accuracy(const ModelTable& table, const Selected& selected, const CellTables& out) {
  for (const RollModel& printed : kRollModels) {
    std::vector<double> near;
    for (const std::size_t i : selected.all) {
      const ModelRow& model = table.models[i];
      if (std::abs(model.roll_rms / printed.rms_deg_s - 1.0) <= 0.1) near.push_back(model.roll_agreement);
    }
    TableRow row = out.claim(
        "Fig. 3", "roll rate of the first lateral multistep",
        "d1 of models whose J_rms is within 10 % of " + significant(printed.rms_deg_s, 3) + " deg/s", "",
        near.empty() ? kNone : quantile(near, 0.5), near.size(), printed.agreement);
    if (near.empty()) {
      out.add_claim(std::move(row), false, "no model has such an rms error");
      continue;
    }
    row.low = quantile(near, 0.025);
    row.high = quantile(near, 0.975);
    row.why =
        "median and 95 % of the models of n = " + std::to_string(table.models[selected.all.front()].order);
    judge_by_order(row, "H's roll rate is larger: an rms error scales with the record, d1 does not");
    out.add(std::move(row));
  }
}

}  // namespace fatmc::candidates
