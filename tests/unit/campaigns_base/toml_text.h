// TOML text as a tree, by way of a file as users have it.
#pragma once

#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <string>

#include "campaigns/base/tree.h"
#include "coordinator/input/toml_file.h"

namespace fatmc {

class TomlTextTest : public testing::Test {
 protected:
  std::string path_ = testing::TempDir() + "spec_" +
                      testing::UnitTest::GetInstance()->current_test_info()->test_suite_name() + "_" +
                      testing::UnitTest::GetInstance()->current_test_info()->name() + ".toml";
  Tree read(const std::string& text) {
    std::ofstream(path_) << text;
    auto tree = read_toml_resolved(path_);
    EXPECT_TRUE(tree) << tree.error().text();
    return tree ? std::move(*tree) : Tree{Tree::Table{}, path_, 0};
  }
  void TearDown() override { std::remove(path_.c_str()); }
};

}  // namespace fatmc
