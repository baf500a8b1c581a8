// A basis shared through a folder, on an experiment of 2 x 20 s.
#include "core/discrepancy/basis_cache.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <thread>

#include "core/discrepancy/basis_file.h"
#include "core/signal/multisine.h"
#include "tests/unit/flight/fat.h"

namespace fatmc {
namespace {

namespace fs = std::filesystem;
constexpr int kPeriod = 1000;

PeriodicExperiment experiment() {
  std::vector<int> lines;
  for (int k = 6; k < 56; k += 2) lines.push_back(k);
  return {lines, kPeriod, 2, 50.0};
}

class BasisCache : public testing::Test {
 protected:
  BasisCache()
      : layout(*FeatureLayout::create(experiment(), true, true, true)),
        grid(*LpmGrid::create(experiment(), {}, 3)),
        model(fat(), setup(), {}, reference(), FeatureExtractor(layout, setup().gain)),
        folder(fs::temp_directory_path() / ("basis_cache_test_" + std::to_string(getpid()))) {
    options.flights = ComparisonBasis::kPaired;
    for (const Effect& e : effect_variants()) {
      if (e.id != "gyro_scale" && e.id != "transport_delay") options.excluded.push_back(e.id);
    }
  }
  ~BasisCache() override { fs::remove_all(folder); }

  static FlightSetup setup() {
    FlightSetup out;
    out.turbulence_m_s = 0.5;
    return out;
  }
  static Eigen::MatrixX3d reference() {
    Eigen::MatrixX3d out(2 * kPeriod, 3);
    RandomStream phases({1, name_hash("basis cache test"), 0, 0}, "excitation");
    for (int axis = 0; axis < 3; ++axis) {
      const std::vector<double> r =
          Multisine::random_phase(kPeriod, experiment().lines, 0.05, phases).samples(2);
      out.col(axis) = Eigen::Map<const Eigen::VectorXd>(r.data(), 2 * kPeriod);
    }
    return out;
  }
  Result<CachedBasis> get(const std::string& where, const std::string& key = kKey) {
    return cached_basis({where, key}, layout, grid, options, [this] {
      ++made;
      return ComparisonBasis::make(model, grid, options);
    });
  }
  [[nodiscard]] std::string text(const CachedBasis& cached) const { return basis_text(cached.basis, kKey); }
  [[nodiscard]] fs::path file() const {
    return folder / ("comparison-" + std::string(kKey).substr(0, 16) + ".basis");
  }

  static constexpr const char* kKey = "0123456789abcdef0123456789abcdef";
  FeatureLayout layout;
  LpmGrid grid;
  ModelSimulator model;
  BasisOptions options;
  fs::path folder;
  std::atomic<int> made = 0;
};

TEST_F(BasisCache, IsMadeOnceHoweverManyAskAtOnceAndEqualsOneThatIsNotShared) {
  const auto alone = get("");
  ASSERT_TRUE(alone);
  EXPECT_EQ(made, 1);
  std::vector<std::string> seen(4);
  {
    std::vector<std::jthread> asking;
    for (std::string& one : seen)
      asking.emplace_back([&] {
        const auto cached = get(folder.string());
        one = cached ? text(*cached) : cached.error().text();
      });
  }
  EXPECT_EQ(made, 2) << "the first made it, the others waited and read";
  for (const std::string& one : seen) EXPECT_TRUE(one == text(*alone)) << "not a bit differs";
  // What is derived from the file, too.
  const auto again = get(folder.string());
  ASSERT_TRUE(again);
  EXPECT_EQ(again->basis.atoms, alone->basis.atoms);
  EXPECT_EQ(again->basis.law.whiten(layout, again->basis.baseline),
            alone->basis.law.whiten(layout, alone->basis.baseline));
}

TEST_F(BasisCache, OfAnotherKeyOrWithABrokenFileIsMadeAnew) {
  ASSERT_TRUE(get(folder.string()));
  ASSERT_TRUE(get(folder.string(), "0123456789abcdefanother key in the same file"));
  EXPECT_EQ(made, 2) << "a name that two keys share does not mix them up";
  const auto whole = get(folder.string());
  EXPECT_EQ(made, 3);
  fs::resize_file(file(), fs::file_size(file()) / 2);
  const auto again = get(folder.string());
  EXPECT_EQ(made, 4);
  EXPECT_TRUE(text(*again) == text(*whole));
}

TEST_F(BasisCache, IsNotHeldUpByTheLockOfAMakerThatIsGone) {
  fs::create_directories(folder);
  std::ofstream(folder / "comparison-0123456789abcdef.lock") << "left behind";
  ASSERT_TRUE(get(folder.string()));
  EXPECT_TRUE(fs::exists(file()));
}

TEST_F(BasisCache, IsUsedAllTheSameWhereTheFolderCannotBeWritten) {
  std::ofstream(folder) << "a file where a folder should be";
  const auto cached = get(folder.string());
  ASSERT_TRUE(cached);
  EXPECT_THAT(cached->trouble, testing::HasSubstr(folder.string()));
  EXPECT_GT(cached->basis.atoms.size(), 0);
}

TEST_F(BasisCache, KeepsTheNewestFiles) {
  fs::create_directories(folder);
  const auto old = fs::file_time_type::clock::now() - std::chrono::hours(1);
  for (int i = 0; i < kMostBases + 3; ++i) {
    const fs::path one = folder / ("comparison-" + std::to_string(i) + ".basis");
    std::ofstream(one) << "old";
    fs::last_write_time(one, old - std::chrono::minutes(i));
  }
  ASSERT_TRUE(get(folder.string()));
  int left = 0;
  for (const auto& entry : fs::directory_iterator(folder))
    left += entry.path().extension() == ".basis" ? 1 : 0;
  EXPECT_EQ(left, kMostBases);
  EXPECT_TRUE(fs::exists(file()));
  EXPECT_TRUE(fs::exists(folder / "comparison-0.basis"));
  EXPECT_FALSE(fs::exists(folder / ("comparison-" + std::to_string(kMostBases + 2) + ".basis")));
}

}  // namespace
}  // namespace fatmc
