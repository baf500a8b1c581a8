// Specs and rows for tests of the store.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "coordinator/store/campaign_store.h"

namespace fatmc {

inline Tree number(std::int64_t value) { return Tree{value, "spec.toml", 9}; }
inline Tree text(std::string value) { return Tree{std::move(value), "spec.toml", 8}; }

inline Tree example_tree(std::int64_t seed, std::int64_t repetitions, double amplitude = 0.25) {
  Tree campaign{Tree::Table{}, "spec.toml", 1};
  campaign.set("study", text("s"));
  campaign.set("seed", number(seed));
  Tree cells{Tree::Array{}, "spec.toml", 4};
  for (const char* name : {"a", "b"}) {
    Tree cell{Tree::Table{}, "spec.toml", 4};
    cell.set("name", text(name));
    cell.set("repetitions", number(repetitions));
    std::get<Tree::Array>(cells.value).items.push_back(cell);
  }
  Tree tree{Tree::Table{}, "spec.toml", 1};
  tree.set("campaign", campaign);
  tree.set("amplitude", Tree{amplitude, "spec.toml", 3});
  tree.set("cell", cells);
  return tree;
}

inline CampaignSpec example_spec(std::int64_t seed = 1, std::int64_t repetitions = 10,
                                 double amplitude = 0.25) {
  return *decode_campaign(example_tree(seed, repetitions, amplitude));
}

inline ComputedRow example_row(std::uint32_t cell, std::uint64_t repetition, double value) {
  ComputedRow out;
  out.row.key = {cell, repetition};
  out.row.metrics = {{"z", value}, {"a", std::numeric_limits<double>::infinity()}, {"zero", -0.0}};
  out.row.arrays = {{"values", {value, -value, std::nan("")}}, {"empty", {}}};
  out.hash = content_hash(out.row);
  out.duration_ns = 1000;
  return out;
}

inline StoreRequest request(std::vector<ComputedRow> rows) {
  StoreRequest out{"worker", 1, "host", 7, std::move(rows), {}};
  out.attempts.assign(out.rows.size(), 1);
  return out;
}

/// A folder of its own for each test.
class StoreFolder : public testing::Test {
 protected:
  void SetUp() override {
    const testing::TestInfo* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::path(testing::TempDir()) /
              ("store_" + std::string(test->test_suite_name()) + "_" + test->name());
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
    path_ = file("c.db");
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  [[nodiscard]] std::string file(const std::string& name) const { return (folder_ / name).string(); }
  std::filesystem::path folder_;
  std::string path_;
};

}  // namespace fatmc
