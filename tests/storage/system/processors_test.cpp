#include "storage/system/processors.h"

#include <gtest/gtest.h>
#include <sched.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "tests/storage/system/temporary_directory.h"

namespace planetree::storage {
namespace {

void write(const std::filesystem::path& path, const std::string& text) {
  std::filesystem::create_directories(path.parent_path());
  std::ofstream(path) << text;
}

/// Groups in a temporary directory, in place of those of the system.
class ProcessorsTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (usable() < 2) GTEST_SKIP() << "one processor";
  }
  unsigned usable() const { return usable_processors(folder_ / "groups", folder_ / "mount"); }
  void set_groups(const std::string& lines) { write(folder_ / "groups", lines); }
  void set(const std::string& file, const std::string& text) {
    write(folder_ / "mount" / file, text);
  }

 private:
  TemporaryDirectory folder_;
};

TEST_F(ProcessorsTest, AreThoseOfTheAffinityMask) {
  cpu_set_t before, one;
  ASSERT_EQ(::sched_getaffinity(0, sizeof before, &before), 0);
  EXPECT_EQ(usable(), static_cast<unsigned>(CPU_COUNT(&before)));
  CPU_ZERO(&one);
  for (int i = 0; CPU_COUNT(&one) == 0; ++i)
    if (CPU_ISSET(i, &before)) CPU_SET(i, &one);
  ASSERT_EQ(::sched_setaffinity(0, sizeof one, &one), 0);
  const unsigned found = usable();
  ASSERT_EQ(::sched_setaffinity(0, sizeof before, &before), 0);
  EXPECT_EQ(found, 1u);
}

TEST_F(ProcessorsTest, AreNoMoreThanTheQuotaOfTheGroup) {
  const unsigned all = usable();
  set_groups("0::/a/b\n");
  set("a/b/cpu.max", "50000 100000\n");
  EXPECT_EQ(usable(), 1u);
  set("a/b/cpu.max", "150000 100000\n");
  EXPECT_EQ(usable(), 2u);
  set("a/b/cpu.max", "max 100000\n");
  EXPECT_EQ(usable(), all);
  set("a/cpu.max", "100000 100000\n");
  EXPECT_EQ(usable(), 1u) << "of a group above";
}

TEST_F(ProcessorsTest, AreNoMoreThanTheQuotaOfAGroupOfVersionOne) {
  set_groups("3:memory:/m\n2:cpuset,cpuacct:/c\n1:cpu,cpuacct:/a\n");
  set("cpu/a/cpu.cfs_quota_us", "-1\n");
  set("cpu/a/cpu.cfs_period_us", "100000\n");
  const unsigned all = usable();
  EXPECT_GT(all, 1u);
  set("cpu/a/cpu.cfs_quota_us", "100000\n");
  EXPECT_EQ(usable(), 1u);
}

TEST_F(ProcessorsTest, AreNotLimitedByWhatCannotBeRead) {
  const unsigned all = usable();
  for (const char* text : {"", "x y\n", "100000\n", "abc 100000\n", "0 0\n"}) {
    set_groups("0::/a\nno group\n");
    set("a/cpu.max", text);
    EXPECT_EQ(usable(), all) << text;
  }
}

TEST_F(ProcessorsTest, AreOfTheGroupThatIsMountedAsTheRoot) {
  set_groups("0::/elsewhere\n");
  set("cpu.max", "10000 100000\n");
  EXPECT_EQ(usable(), 1u);
}

}  // namespace
}  // namespace planetree::storage
