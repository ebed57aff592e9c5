#include "storage/spill/work_directory.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <optional>

#include "tests/storage/file/file_image.h"
#include "tests/storage/system/faulty_calls.h"
#include "tests/storage/system/temporary_directory.h"

namespace planetree::storage {
namespace {

class WorkDirectoryTest : public testing::Test {
 protected:
  using Names = std::vector<std::string>;

  // Code of the error on opening the directory or a file in it; none if both open.
  std::optional<ErrorCode> refusal() const {
    auto work = WorkDirectory::open(path_);
    if (!work) return work.error().code;
    auto file = work->open_file("file");
    if (!file) return file.error().code;
    return {};
  }
  void plant_directory() const { std::filesystem::create_directory(path_); }

  const TemporaryDirectory folder_;
  const std::filesystem::path path_ = folder_ / "work";
  const std::filesystem::path precious_ = folder_ / "precious";
};

TEST_F(WorkDirectoryTest, KeepsFilesUntilItIsRemoved) {
  const Bytes bytes(100, std::byte{42});
  {
    auto work = WorkDirectory::open(path_);
    ASSERT_TRUE(work) << work.error().text;
    auto file = work->open_file("file");
    ASSERT_TRUE(file);
    ASSERT_TRUE(file->write_at(0, bytes));
    ASSERT_TRUE(work->sync_names());
  }
  EXPECT_EQ(read_bytes(path_ / "file"), bytes);
  auto work = WorkDirectory::open(path_);
  ASSERT_TRUE(work) << work.error().text;
  auto file = work->open_file("file");
  ASSERT_TRUE(file);
  Bytes found(bytes.size());
  ASSERT_TRUE(file->read_at(0, found));
  EXPECT_EQ(found, bytes);
  EXPECT_TRUE(work->remove());
  EXPECT_EQ(folder_.names(), Names{});
}

TEST_F(WorkDirectoryTest, IsExclusiveToOneOpener) {
  {
    const auto first = WorkDirectory::open(path_);
    ASSERT_TRUE(first);
    const auto second = WorkDirectory::open(path_);
    ASSERT_FALSE(second);
    EXPECT_EQ(second.error().code, ErrorCode::kAlreadyExists);
    EXPECT_STREQ(second.error().text,
                 "another process runs the same build; wait for it or name another output");
  }
  EXPECT_TRUE(WorkDirectory::open(path_));
}

// Simulates a lock of a process that was killed and that the system has not yet cleaned up.
class DyingCalls final : public FileCalls {
 public:
  int flock(int descriptor, int operation) noexcept override {
    if (++attempts_ < 3) {
      errno = EWOULDBLOCK;
      return -1;
    }
    return FileCalls::flock(descriptor, operation);
  }

 private:
  int attempts_ = 0;
};

TEST_F(WorkDirectoryTest, WaitsForAProcessThatIsAboutToEnd) {
  DyingCalls calls;
  EXPECT_TRUE(WorkDirectory::open(path_, calls));
}

// Simulates a process that removes the directory between two calls of another.
class RemovingCalls final : public FileCalls {
 public:
  explicit RemovingCalls(std::filesystem::path path) : path_(std::move(path)) {}
  int flock(int descriptor, int operation) noexcept override {
    if (std::exchange(armed_, false)) std::filesystem::remove_all(path_);
    return FileCalls::flock(descriptor, operation);
  }

 private:
  const std::filesystem::path path_;
  bool armed_ = true;
};

TEST_F(WorkDirectoryTest, IsRecreatedIfRemovedBeforeItIsLocked) {
  RemovingCalls calls(path_);
  auto work = WorkDirectory::open(path_, calls);
  ASSERT_TRUE(work) << work.error().text;
  ASSERT_TRUE(work->open_file("file"));
  EXPECT_TRUE(std::filesystem::exists(path_ / "file"));
  EXPECT_FALSE(WorkDirectory::open(path_));
}

TEST_F(WorkDirectoryTest, FollowsNoLinks) {
  std::filesystem::create_directory(precious_);
  std::filesystem::create_directory_symlink(precious_, path_);
  EXPECT_EQ(refusal(), ErrorCode::kAlreadyExists);
  EXPECT_TRUE(std::filesystem::is_empty(precious_));
  std::filesystem::remove(path_);
  std::filesystem::remove(precious_);
  write_bytes(precious_, Bytes(5, std::byte{42}));
  for (const char* name : {"lock", "file"}) {
    plant_directory();
    std::filesystem::create_symlink(precious_, path_ / name);
    EXPECT_EQ(refusal(), ErrorCode::kAlreadyExists) << name;
    std::filesystem::remove_all(path_);
    plant_directory();
    std::filesystem::create_hard_link(precious_, path_ / name);
    EXPECT_EQ(refusal(), ErrorCode::kAlreadyExists) << name;
    std::filesystem::remove_all(path_);
  }
}

TEST_F(WorkDirectoryTest, RefusesOtherKindsOfFiles) {
  write_bytes(path_, Bytes(5, std::byte{42}));
  EXPECT_EQ(refusal(), ErrorCode::kAlreadyExists);
  EXPECT_EQ(std::filesystem::file_size(path_), 5u);
  std::filesystem::remove(path_);
  for (const char* name : {"lock", "file"}) {
    plant_directory();
    ASSERT_EQ(::mkfifo((path_ / name).c_str(), 0600), 0);
    EXPECT_EQ(refusal(), ErrorCode::kAlreadyExists) << name;
    std::filesystem::remove_all(path_);
    plant_directory();
    std::filesystem::create_directory(path_ / name);
    EXPECT_EQ(refusal(), ErrorCode::kAlreadyExists) << name;
    std::filesystem::remove_all(path_);
  }
}

TEST_F(WorkDirectoryTest, RefusesDirectoriesAndFilesWritableByOthers) {
  plant_directory();
  ASSERT_EQ(::chmod(path_.c_str(), 0777), 0);
  EXPECT_EQ(refusal(), ErrorCode::kPermission);
  ASSERT_EQ(::chmod(path_.c_str(), 0700), 0);
  EXPECT_EQ(refusal(), std::nullopt);
  ASSERT_EQ(::chmod((path_ / "file").c_str(), 0622), 0);
  EXPECT_EQ(refusal(), ErrorCode::kPermission);
}

TEST_F(WorkDirectoryTest, LeavesFilesItDidNotOpen) {
  auto work = WorkDirectory::open(path_);
  ASSERT_TRUE(work && work->open_file("file"));
  write_bytes(path_ / "precious", Bytes(5, std::byte{42}));
  EXPECT_TRUE(work->remove());
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(path_), {}), 1);
}

TEST_F(WorkDirectoryTest, AFailedCallIsACleanError) {
  for (int at = 0;; ++at) {
    FaultyCalls calls;
    calls.fault = FaultyCalls::Fault::kError;
    calls.number = ENOSPC;
    calls.fault_at = at;
    bool failed = false;
    {
      auto work = WorkDirectory::open(path_, calls);
      failed = !work || !work->open_file("file") || !work->sync_names() || !work->remove();
    }
    if (!calls.happened()) break;
    // A failed close is harmless, and a failed removal is tried again.
    EXPECT_NE(failed, calls.failed_call() == "close" || calls.failed_call() == "unlinkat")
        << calls.failed_call();
    std::filesystem::remove_all(path_);
  }
}

}  // namespace
}  // namespace planetree::storage
