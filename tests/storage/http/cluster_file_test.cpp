// The file of clusters: what comes back, what does not, and its limit.

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <vector>

#include "storage/http/cluster_file.h"
#include "tests/storage/system/faulty_calls.h"
#include "tests/storage/system/temporary_directory.h"

namespace planetree::storage {
namespace {

class ClusterFileTest : public testing::Test {
 protected:
  using Cluster = std::vector<std::byte>;
  static constexpr Hash128 kObject{1, 2};
  static constexpr std::uint64_t kLimit = 8 * ClusterFile::kMinBytes;

  std::unique_ptr<ClusterFile> open(std::uint64_t max_bytes = kLimit) {
    auto file = ClusterFile::open(folder_ / "cache", max_bytes);
    if (!file) ADD_FAILURE() << file.error().text;
    return file ? std::move(*file) : nullptr;
  }
  static Cluster cluster(std::uint64_t number) {
    Cluster bytes(kClusterBytes);
    for (std::size_t i = 0; i < bytes.size(); ++i)
      bytes[i] = static_cast<std::byte>(i * 31 + number * 7 + i / 251);
    return bytes;
  }
  static bool has(const ClusterFile& file, std::uint64_t number, const Hash128& object = kObject) {
    Cluster bytes(kClusterBytes);
    if (!file.read(object, number, bytes)) return false;
    EXPECT_EQ(bytes, cluster(number));
    return true;
  }
  std::filesystem::path path() const { return folder_ / "cache" / "planetree-clusters"; }

  // Changes one byte in the middle of each slot.
  void damage(std::uint64_t at) const {
    std::FILE* const file = std::fopen(path().c_str(), "r+b");
    for (std::uint64_t slot = 0; slot < kLimit / ClusterFile::kSlotBytes; ++slot) {
      const auto offset = static_cast<long>(slot * ClusterFile::kSlotBytes + at);
      std::fseek(file, offset, SEEK_SET);
      const int byte = std::fgetc(file);
      std::fseek(file, offset, SEEK_SET);
      if (byte != EOF) std::fputc(byte ^ 1, file);
    }
    std::fclose(file);
  }

  TemporaryDirectory folder_;
};

TEST_F(ClusterFileTest, KeepsClustersForLaterProcesses) {
  open()->write(kObject, 5, cluster(5));
  const auto file = open();
  EXPECT_TRUE(has(*file, 5));
  EXPECT_FALSE(has(*file, 6));
  EXPECT_FALSE(has(*file, 5, {1, 3}));
  std::byte shorter[100];
  EXPECT_FALSE(file->read(kObject, 5, shorter));
}

TEST_F(ClusterFileTest, ForgetsACluster) {
  const auto file = open();
  file->write(kObject, 5, cluster(5));
  file->forget(kObject, 5);
  file->forget(kObject, 6);
  EXPECT_FALSE(has(*file, 5));
}

TEST_F(ClusterFileTest, NeverExceedsItsLimit) {
  const auto file = open();
  for (std::uint64_t number = 0; number < 200; ++number) {
    file->write(kObject, number, cluster(number));
    ASSERT_TRUE(has(*file, number));
  }
  EXPECT_LE(std::filesystem::file_size(path()), kLimit);
  unsigned kept = 0;
  for (std::uint64_t number = 0; number < 200; ++number) kept += has(*file, number);
  EXPECT_GE(kept, 16u);
  EXPECT_LE(kept, 32u);
  // A lower limit cuts it.
  open(ClusterFile::kMinBytes);
  EXPECT_LE(std::filesystem::file_size(path()), ClusterFile::kMinBytes);
  for (std::uint64_t number = 0; number < 200; ++number) has(*file, number);
}

TEST_F(ClusterFileTest, DamagedBytesAreAbsent) {
  const std::uint64_t places[] = {0, 8, 24, 32, 40, 4096, 4096 + kClusterBytes - 1};
  for (const std::uint64_t at : places) {
    const auto file = open();
    file->write(kObject, 5, cluster(5));
    ASSERT_TRUE(has(*file, 5));
    damage(at);
    EXPECT_FALSE(has(*file, 5)) << at;
  }
}

TEST_F(ClusterFileTest, ACrashLeavesNoWrongCluster) {
  // Cut after each step of a write: the old head away, half of the bytes, all but the head.
  const auto file = open();
  file->write(kObject, 5, cluster(5));
  const std::uint64_t bytes = std::filesystem::file_size(path());
  for (const std::uint64_t left : {std::uint64_t{10}, bytes / 2, bytes - 1}) {
    std::filesystem::resize_file(path(), left);
    EXPECT_FALSE(has(*file, 5)) << left;
    file->write(kObject, 5, cluster(5));
    EXPECT_TRUE(has(*file, 5));
  }
}

TEST_F(ClusterFileTest, TwoMayWriteAtOnce) {
  const auto one = open(), other = open();
  for (std::uint64_t number = 0; number < 60; ++number) {
    one->write(kObject, number, cluster(number));
    other->write(kObject, number, cluster(number));
    EXPECT_TRUE(has(*one, number));
    EXPECT_TRUE(has(*other, number));
  }
}

TEST_F(ClusterFileTest, BelongsToItsUserAlone) {
  open();
  struct stat status {};
  ASSERT_EQ(::stat(path().c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777, 0600u);
}

TEST_F(ClusterFileTest, ErrorsAreValues) {
  const auto small = ClusterFile::open(folder_ / "cache", ClusterFile::kMinBytes - 1);
  ASSERT_FALSE(small);
  EXPECT_EQ(small.error().code, ErrorCode::kBadArgument);
  std::FILE* const file = std::fopen((folder_ / "file").c_str(), "w");
  std::fclose(file);
  EXPECT_FALSE(ClusterFile::open(folder_ / "file", kLimit));
}

}  // namespace
}  // namespace planetree::storage
