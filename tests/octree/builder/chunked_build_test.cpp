#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "storage/file/page_file.h"
#include "tests/octree/builder/build_fixture.h"
#include "tests/storage/system/faulty_calls.h"

namespace planetree::octree {
namespace {

class Silent final : public BuildProgress {
 public:
  Result<void> progress(BuildPhase, std::uint64_t, std::uint64_t) override { return {}; }
  void failed_at(BuildDirectory index, const std::filesystem::path&) override {
    failed_at_ = index;
  }
  std::optional<BuildDirectory> failed_at() const { return failed_at_; }

 private:
  std::optional<BuildDirectory> failed_at_;
};

struct BuildCase {
  const char* name;
  Soup soup;
};

std::vector<BuildCase> build_cases() {
  Soup holed = sphere(4);
  holed.resize(holed.size() - 5);
  return {{"sphere", sphere(4)},
          {"with a hole", holed},
          {"grains", grains(300, 0.05)},
          {"in one place", repeated(700)},
          {"nested", joined({sphere(4), inside_out(scaled(sphere(3), 0.5))})},
          {"one large, many small",
           joined({scaled(sphere(3), 0x1p-8), translated(scaled(sphere(3), 0x1p-9), {0.2, 0, 0}),
                   box({-1, -1, -1}, {1, 1, 1})})}};
}

class ChunkedBuild : public SmallChunks {
 protected:
  Result<BuildReport> build(const BuildMemory& memory,
                            storage::FileCalls& calls = storage::FileCalls::real(),
                            bool replace = true) {
    BuildOptions options;
    options.page_bytes = 4096;
    options.replace = replace;
    options.box = box_;
    Silent silent;
    auto report = build_tree(mesh_, output_, options, silent, {40, 60, memory, calls});
    failed_at_ = silent.failed_at();
    return report;
  }

  std::optional<RegionBox> box_;
  std::optional<BuildDirectory> failed_at_;  // of the last build
};

TEST_F(ChunkedBuild, WritesTheSameBytesWithAnyMemory) {
  for (const BuildCase& c : build_cases()) {
    SCOPED_TRACE(c.name);
    write_in_random_order(c.soup);
    ASSERT_TRUE(build(kLarge));
    const storage::Bytes expected = built();
    for (const BuildMemory& memory : {kTight, kBetween, kSortedOnDisk}) {
      const auto report = build(memory);
      ASSERT_TRUE(report) << report.error().text;
      EXPECT_EQ(built(), expected);
    }
  }
}

TEST_F(ChunkedBuild, WritesTheSameBytesOfARegionWithAnyMemory) {
  for (const BuildCase& c : build_cases()) {
    SCOPED_TRACE(c.name);
    write(c.soup);
    box_.reset();
    ASSERT_TRUE(build(kLarge));
    const storage::Bytes whole = built();
    for (const RegionBox& box :
         {RegionBox{{-0.1, -0.2, -0.3}, {0.9, 0.5, 1.5}}, RegionBox{{-9, -9, 0}, {9, 9, 9}}}) {
      box_ = box;
      ASSERT_TRUE(build(kLarge));
      const storage::Bytes expected = built();
      EXPECT_NE(expected, whole);
      // Caps are those of the whole surface, and need not touch the region.
      EXPECT_LE(expected.size(), whole.size() + 64);
      BuildMemory held = kBetween;
      held.part_bytes = 3000;
      for (const BuildMemory& memory : {kTight, kBetween, held}) {
        const auto report = build(memory);
        ASSERT_TRUE(report) << report.error().text;
        EXPECT_EQ(built(), expected);
      }
    }
  }
}

// After the edges are matched, only the region is built.
TEST_F(ChunkedBuild, WritesOnlyTheTrianglesOfARegion) {
  write(sphere(5));
  ASSERT_TRUE(build(kTight));
  const auto whole = storage::PageFile::open(output_);
  ASSERT_TRUE(whole);
  const std::uint32_t pages = whole->page_count();
  box_ = {{0.5, 0.5, 0.5}, {0.6, 0.6, 0.6}};
  const auto report = build(kTight);
  ASSERT_TRUE(report);
  EXPECT_LT(report->header.page_count, pages / 10);
  EXPECT_LT(report->header.model.triangle_count, 400u);
  EXPECT_EQ(report->header.model.input_triangles, sphere(5).size());
  EXPECT_EQ(report->frame.triangle_count, sphere(5).size());
  EXPECT_EQ(report->header.model.unbalanced_edge_count, 0u);
}

TEST_F(ChunkedBuild, LeavesNoOtherFiles) {
  write(sphere(3));
  ASSERT_TRUE(build(kTight));
  EXPECT_EQ(folder_.names(), std::vector<std::string>{"model.ptree"});
}

TEST_F(ChunkedBuild, ReportsFailuresOfTheInput) {
  write({});
  EXPECT_FALSE(build(kTight));
  EXPECT_EQ(failed_at_, BuildDirectory::kInput);
  mesh_ = meshes_ / "none.stl";
  EXPECT_FALSE(build(kTight));
  EXPECT_EQ(failed_at_, BuildDirectory::kInput);
}

// The n-th system call fails, for each n: the build reports an error or writes the whole file, and
// leaves nothing else.
class ChunkedBuildFaults : public ChunkedBuild,
                           public testing::WithParamInterface<storage::FaultyCalls::Fault> {
 protected:
  using Fault = storage::FaultyCalls::Fault;

  // Error texts are for people, so failed_at() must report the directory too.
  static std::optional<BuildDirectory> index_of(const Result<BuildReport>& report) {
    if (report) return {};
    const std::string_view text = report.error().text;
    const auto says = [text](std::string_view words) {
      return text.find(words) != std::string_view::npos;
    };
    if (says("temporary file")) return BuildDirectory::kTemporary;
    return says("the mesh") || says("cannot be opened") ? BuildDirectory::kInput
                                                        : BuildDirectory::kOutput;
  }
};

TEST_P(ChunkedBuildFaults, LeaveTheOldFileOrTheWholeNewOne) {
  write_in_random_order(sphere(2));
  const auto in_memory = build(kLarge), spilled = build(kTight), sorted = build(kSortedOnDisk);
  ASSERT_TRUE(in_memory && spilled && sorted);
  ASSERT_GT(sorted->temporary_bytes, spilled->temporary_bytes);
  const storage::Bytes expected = built();
  const storage::Bytes old(17, std::byte{42});
  for (const bool lacks_unnamed_files : {false, true}) {
    if (lacks_unnamed_files && GetParam() != Fault::kError) continue;
    std::map<std::string, int> failed;
    for (int fault_at = 0;; ++fault_at) {
      storage::write_bytes(output_, old);
      storage::FaultyCalls calls;
      calls.lacks_unnamed_files = lacks_unnamed_files;
      calls.fault = GetParam();
      calls.number = fault_at % 2 == 0 ? EIO : ENOSPC;
      calls.fault_at = fault_at;
      const auto report = build(kSortedOnDisk, calls);
      ASSERT_EQ(folder_.names(), std::vector<std::string>{"model.ptree"}) << calls.failed_call();
      if (!calls.happened()) {
        EXPECT_TRUE(report);
        break;
      }
      ASSERT_TRUE(report || GetParam() == Fault::kError) << report.error().text;
      EXPECT_EQ(failed_at_, index_of(report)) << calls.failed_call();
      // The directory is synced after the file has its name.
      const bool named = calls.failed_call() == "fsync" && calls.fsync_count() == 2;
      ASSERT_EQ(built(), report || named ? expected : old) << calls.failed_call();
      ++failed[calls.failed_call()];
    }
    const bool is_short = GetParam() == Fault::kShort;
    EXPECT_GT(is_short ? failed["short"] : std::min(failed["pread"], failed["pwrite"]), 10);
  }
}

INSTANTIATE_TEST_SUITE_P(Every, ChunkedBuildFaults,
                         testing::Values(storage::FaultyCalls::Fault::kError,
                                         storage::FaultyCalls::Fault::kInterrupt,
                                         storage::FaultyCalls::Fault::kShort));

}  // namespace
}  // namespace planetree::octree
