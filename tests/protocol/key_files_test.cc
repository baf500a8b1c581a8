#include "proto/key_files.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

namespace fatmc {
namespace {

namespace fs = std::filesystem;

class KeyFiles : public testing::Test {
 protected:
  void SetUp() override {
    char name[] = "/tmp/fatmc_keys_XXXXXX";
    root_ = ::mkdtemp(name);
    folder_ = root_ / "keys";
  }
  void TearDown() override { fs::remove_all(root_); }
  void make() { ASSERT_TRUE(write_key_files(folder_)); }
  void write(const char* name, const std::string& text) { std::ofstream(folder_ / name) << text; }
  void mode(const char* name, mode_t bits) { ASSERT_EQ(::chmod((folder_ / name).c_str(), bits), 0); }
  static mode_t mode_of(const fs::path& path) {
    struct stat found {};
    return ::stat(path.c_str(), &found) == 0 ? found.st_mode & 07777 : 0;
  }
  fs::path root_, folder_;
};

TEST_F(KeyFiles, AreForTheirOwnerAloneAndFitTogether) {
  make();
  EXPECT_EQ(mode_of(folder_), 0700U);
  for (const char* name : {"coordinator.key", "coordinator.pub", "worker.key", "workers.pub"})
    EXPECT_EQ(mode_of(folder_ / name), 0600U) << name;
  const Result<CoordinatorKeys> coordinator = read_coordinator_keys(folder_);
  const Result<WorkerKeys> worker = read_worker_keys(folder_);
  ASSERT_TRUE(coordinator) << coordinator.error().text();
  ASSERT_TRUE(worker) << worker.error().text();
  EXPECT_EQ(worker->coordinator, coordinator->own.open);
  EXPECT_TRUE(coordinator->admitted.contains(worker->own.open));
  EXPECT_NE(worker->own.secret, coordinator->own.secret);
}

TEST_F(KeyFiles, AreNotOverwritten) {
  make();
  const Result<WorkerKeys> before = read_worker_keys(folder_);
  fs::remove(folder_ / "coordinator.key");  // the rest is enough to refuse
  const Status again = write_key_files(folder_);
  ASSERT_FALSE(again);
  EXPECT_NE(again.error().text().find("is not overwritten"), std::string::npos);
  EXPECT_FALSE(fs::exists(folder_ / "coordinator.key"));
  EXPECT_EQ(read_worker_keys(folder_)->own.secret, before->own.secret);
}

TEST_F(KeyFiles, ThatOthersMayReadAreRefused) {
  make();
  for (const mode_t bits : {0640, 0604, 0660, 0610}) {
    mode("worker.key", bits);
    const Result<WorkerKeys> keys = read_worker_keys(folder_);
    ASSERT_FALSE(keys) << bits;
    EXPECT_NE(keys.error().text().find("worker.key: may be read or written by others"), std::string::npos)
        << keys.error().text();
  }
}

TEST_F(KeyFiles, AListThatOthersMayWriteIsRefusedOneTheyMayReadIsNot) {
  make();
  mode("workers.pub", 0644);
  EXPECT_TRUE(read_coordinator_keys(folder_));
  mode("workers.pub", 0664);
  EXPECT_FALSE(read_coordinator_keys(folder_));
}

TEST_F(KeyFiles, TheListTakesCommentsAndSeveralWorkersAndNamesTheLineOfNonsense) {
  make();
  const CurvePair one = make_curve_pair(), two = make_curve_pair();
  write("workers.pub", "# ours\n" + key_text(one.open) + "  # first\n\n  " + key_text(two.open) + "\n");
  EXPECT_EQ(read_coordinator_keys(folder_)->admitted, (std::set<CurveKey>{one.open, two.open}));
  write("workers.pub", key_text(one.open) + "\nabc\n");
  const Result<CoordinatorKeys> keys = read_coordinator_keys(folder_);
  ASSERT_FALSE(keys);
  EXPECT_NE(keys.error().text().find("workers.pub:2: is no key"), std::string::npos) << keys.error().text();
  EXPECT_EQ(keys.error().text().find("abc"), std::string::npos) << "what may be a secret is not repeated";
}

TEST_F(KeyFiles, WrongContentIsRefused) {
  make();
  for (const std::string& text : {std::string(), std::string("# nothing\n"), std::string(63, 'a') + "\n",
                                  std::string(64, 'g') + "\n", std::string(2 << 20, 'a')}) {
    write("worker.key", text);
    EXPECT_FALSE(read_worker_keys(folder_)) << text.size();
  }
  EXPECT_FALSE(read_worker_keys(root_ / "nowhere"));
  fs::remove(folder_ / "worker.key");
  fs::create_directory(folder_ / "worker.key");
  EXPECT_FALSE(read_worker_keys(folder_));
}

TEST(KeyDescriptor, GivesEveryReaderTheSameKeysAndNonsenseIsAnError) {
  const RunKeys keys = make_run_keys();
  const int descriptor = open_worker_keys(keys.worker);
  for (int i = 0; i < 2; ++i) {
    const Result<WorkerKeys> back = read_worker_keys_from(descriptor);
    ASSERT_TRUE(back);
    EXPECT_EQ(back->own.open, keys.worker.own.open);
    EXPECT_EQ(back->own.secret, keys.worker.own.secret);
    EXPECT_EQ(back->coordinator, keys.coordinator.own.open);
  }
  ::close(descriptor);
  EXPECT_FALSE(read_worker_keys_from(descriptor));
}

}  // namespace
}  // namespace fatmc
