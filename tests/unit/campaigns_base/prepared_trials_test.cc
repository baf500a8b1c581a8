#include "campaigns/base/prepared_trials.h"

#include "campaigns/base/decoder.h"
#include "tests/unit/campaigns_base/toml_text.h"

namespace fatmc {
namespace {

// A study that gives back what it reads: [model] mass, at most 30, and the cell's own `factor`.
class EchoCell final : public PreparedCell {
 public:
  EchoCell(double mass, double own) : mass_(mass), own_(own) {}
  [[nodiscard]] TrialRow run(std::uint64_t repetition) const override {
    TrialRow row;
    row.key = {0, repetition};
    row.metrics = {{"mass", mass_}, {"own", own_}};
    row.arrays = {{"values", {mass_}}};
    if (repetition % 2 == 1) row.outcome = "diverged";
    return row;
  }
  [[nodiscard]] std::optional<TrialRecord> record(std::uint64_t repetition) const override {
    TrialRecord out;
    out.names = {"t", "p"};
    out.columns = Eigen::MatrixXd::Constant(3, 2, static_cast<double>(repetition));
    return out;
  }

 private:
  double mass_, own_;
};

Result<std::unique_ptr<PreparedCell>> prepare_echo(const CampaignSpec& spec, std::uint32_t cell) {
  Decoder top(spec.tree, "");
  for (const char* key : {"campaign", "cell"}) top.skip(key);
  double mass = 0.0;
  if (const Tree* model = top.table("model")) {
    Decoder table(*model, "model");
    mass = table.real("mass", {.low = 0.0, .high = 30.0});
    top.take(table.finish());
  }
  Decoder own(spec.cells.at(cell).tree, "cell");
  for (const char* key : {"name", "repetitions"}) own.skip(key);
  const double factor = own.real("factor", {}, 1.0);
  top.take(own.finish());
  if (Status status = top.finish(); !status) return fail(status.error());
  return std::make_unique<EchoCell>(mass, factor);
}

const TrialStudy kEcho{"echo", &prepare_echo};
const std::string kHead = "[campaign]\nstudy = \"echo\"\nseed = 1\n[model]\nmass = 20.0\n";
const std::string kCell = "[[cell]]\nname = \"c\"\nrepetitions = 5\n";
const std::string kNormal =
    "[[dispersion]]\npath = \"model.mass\"\nlaw = \"normal\"\nmean = 20.0\nsd = 3.0\n";

class PreparedTrials : public TomlTextTest {
 protected:
  std::unique_ptr<PreparedCell> prepare(const std::string& text, std::uint32_t cell = 0) {
    const auto spec = decode_campaign(read(text));
    EXPECT_TRUE(spec) << spec.error().text();
    auto prepared = prepare_trials(kEcho, *spec, cell);
    EXPECT_TRUE(prepared) << prepared.error().text();
    return prepared ? std::move(*prepared) : nullptr;
  }
  std::string error_of(const std::string& text) {
    const auto spec = decode_campaign(read(text));
    EXPECT_TRUE(spec) << spec.error().text();
    const auto prepared = prepare_trials(kEcho, *spec, 0);
    return prepared ? "no error" : prepared.error().text().substr(path_.size() + 1);
  }
};

double metric(const TrialRow& row, const std::string& name) {
  for (const auto& [key, value] : row.metrics) {
    if (key == name) return value;
  }
  ADD_FAILURE() << "no metric " << name;
  return 0.0;
}

TEST_F(PreparedTrials, ACellSetsValuesOfAnyTableAndOfItself) {
  const std::string text = kHead + kCell + "[cell.set]\nmodel.mass = 22\n\"cell.factor\" = 3.5\n";
  const TrialRow row = prepare(text)->run(0);
  EXPECT_EQ(metric(row, "mass"), 22.0);
  EXPECT_EQ(metric(row, "own"), 3.5);
  EXPECT_EQ(metric(prepare(kHead + kCell)->run(0), "mass"), 20.0);
}

TEST_F(PreparedTrials, AKeyThatAStudyDoesNotKnowIsAnErrorAtTheValueThatSetsIt) {
  EXPECT_EQ(error_of(kHead + kCell + "[cell.set]\nmodel.mas = 22\n"),
            "10: model.mas: is not a known key, the keys here are: mass");
  EXPECT_EQ(error_of(kHead + kCell + "[cell.set]\nmodel.mass = 40\n"),
            "10: model.mass: 40 is out of range, write a value between 0 and 30");
  EXPECT_EQ(error_of(kHead + kCell + "[cell.set]\n\"campaign.seed\" = 2\n"),
            "10: cell.set.campaign.seed: is not for a cell to set");
}

TEST_F(PreparedTrials, DrawnValuesReachTheStudyAndStandFirstInTheRow) {
  const auto cell = prepare(kHead + kCell + kNormal);
  for (const std::uint64_t repetition : {0, 1, 2}) {
    const TrialRow row = cell->run(repetition);
    EXPECT_EQ(row.metrics.front().first, "draw.mass");
    EXPECT_EQ(row.metrics.front().second, metric(row, "mass"));
    EXPECT_EQ(row, cell->run(repetition)) << "a trial is a pure function";
  }
  EXPECT_NE(metric(cell->run(0), "mass"), metric(cell->run(1), "mass"));
}

TEST_F(PreparedTrials, ACellWithoutDispersionFliesTheNominalValues) {
  const TrialRow row = prepare(kHead + kCell + "disperse = false\n" + kNormal)->run(0);
  EXPECT_EQ(metric(row, "mass"), 20.0);
  EXPECT_EQ(row.metrics.front().first, "mass");
}

TEST_F(PreparedTrials, ADrawThatCannotBeFlownIsAnOutcomeWithoutAFileName) {
  const auto cell = prepare(
      kHead + kCell + "[[dispersion]]\npath = \"model.mass\"\nlaw = \"normal\"\nmean = 20.0\nsd = 1000.0\n");
  int infeasible = 0;
  for (std::uint64_t repetition = 0; repetition < 20; ++repetition) {
    const TrialRow row = cell->run(repetition);
    if (row.outcome != "infeasible") continue;
    ++infeasible;
    EXPECT_EQ(row.detail.find("model.mass: "), 0U) << row.detail;
    EXPECT_EQ(row.detail.find(path_), std::string::npos);
    EXPECT_EQ(row.metrics.front().first, "draw.mass");
  }
  EXPECT_GT(infeasible, 10);
}

TEST_F(PreparedTrials, ADispersionOfNothingIsFoundBeforeAnyTrial) {
  EXPECT_EQ(error_of(kHead + kCell +
                     "[[dispersion]]\npath = \"model.weight\"\nlaw = \"normal\"\nmean = 2\nsd = 1\n"),
            "10: model.weight: is not a known key, the keys here are: mass");
  EXPECT_EQ(error_of(kHead + kCell + "set.\"model.mass\" = 21\n" + kNormal).substr(0, 40),
            "9: model.mass: is set here and drawn by ");
}

TEST_F(PreparedTrials, WhatIsKeptOfATrialIsWhatTheSpecSays) {
  const TrialRow all = prepare(kHead + kCell)->run(1);
  EXPECT_EQ(all.arrays.size(), 1U);
  EXPECT_TRUE(prepare(kHead + kCell + "[keep]\narrays = false\n")->run(1).arrays.empty());
  const auto failures = prepare(kHead + kCell + "[keep]\nrecords = \"failures\"\n");
  EXPECT_EQ(failures->run(2).arrays.size(), 1U);
  const TrialRow failed = failures->run(3);
  ASSERT_NE(failed.array("record.p"), nullptr);
  EXPECT_EQ(*failed.array("record.p"), (std::vector{3.0, 3.0, 3.0}));
  EXPECT_NE(prepare(kHead + kCell + "[keep]\nrecords = \"all\"\n")->run(2).array("record.t"), nullptr);
}

}  // namespace
}  // namespace fatmc
