// The files of builds that can be resumed: damaged, failing, or short of space.

#include <gtest/gtest.h>

#include <cerrno>
#include <map>
#include <string>
#include <system_error>

#include "octree/builder/mesh/mesh_size.h"
#include "octree/builder/sort/triangles.h"
#include "octree/builder/space_need.h"
#include "octree/page/page_streams.h"
#include "tests/octree/builder/resumed_build.h"

namespace planetree::octree {
namespace {

class ResumedBuildFiles : public ResumedBuild {};

// Damages one byte of any record.
TEST_F(ResumedBuildFiles, IgnoresDamagedJournalRecords) {
  for (const bool open : {false, true}) {
    write(open ? holed() : sphere(2));
    const storage::Bytes expected = whole();
    stop_in(open ? BuildPhase::kBuildingTree : BuildPhase::kBuildingMask, 2);
    const storage::Bytes journal = storage::read_bytes(work_ / "journal"),
                         spill = storage::read_bytes(work_ / "spill");
    for (std::size_t at = 0; at < journal.size(); at += 11) {
      storage::Bytes damaged = journal;
      damaged[at] ^= std::byte{4};
      std::filesystem::create_directory(work_);
      std::filesystem::permissions(work_, std::filesystem::perms::owner_all);
      storage::write_bytes(work_ / "journal", damaged);
      storage::write_bytes(work_ / "spill", spill);
      expect_completed(expected);
      // The last record of the journal is that of a sector, or of a chunk if the model is open.
      EXPECT_TRUE(recorder_.did(BuildPhase::kBuildingTree));
      EXPECT_TRUE(at >= 100 || recorder_.start.starts_with("the checkpoint cannot be resumed"));
      std::filesystem::remove(output_);
    }
  }
}

TEST_F(ResumedBuildFiles, ResumesOnlyWhatATruncatedSpillFileHolds) {
  write(sphere(2));
  const storage::Bytes expected = whole();
  stop_in(BuildPhase::kBuildingMask, 4);
  const storage::Bytes journal = storage::read_bytes(work_ / "journal"),
                       spill = storage::read_bytes(work_ / "spill");
  std::uint64_t resumed = 0;
  for (std::size_t size = 0; size < spill.size(); size += 509) {
    std::filesystem::create_directory(work_);
    std::filesystem::permissions(work_, std::filesystem::perms::owner_all);
    storage::write_bytes(work_ / "journal", journal);
    storage::write_bytes(work_ / "spill", std::span(spill).first(size));
    expect_completed(expected);
    EXPECT_GE(recorder_.count(BuildPhase::kBuildingTree).resumed, resumed);
    resumed = recorder_.count(BuildPhase::kBuildingTree).resumed;
    EXPECT_FALSE(resumed > 0 && recorder_.did(BuildPhase::kMatching));
    std::filesystem::remove(output_);
  }
  EXPECT_GT(resumed, 0u);
}

TEST_F(ResumedBuildFiles, LeavesNoCheckpointOfFailedInputs) {
  storage::write_bytes(mesh_, storage::Bytes(200, std::byte{'x'}));
  ASSERT_FALSE(build());
  EXPECT_EQ(folder_.names(), Names{});
  std::filesystem::remove(mesh_);
  const auto report = build();
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().code, ErrorCode::kNotFound);
  EXPECT_EQ(folder_.names(), Names{});
}

/// Lets the n-th system call on an open file fail.
class FailingFile final : public storage::FileCalls {
 public:
  explicit FailingFile(int fail_at) : fail_at_(fail_at) {}
  // The path of the file whose call failed; empty if none did.
  const std::string& name() const { return name_; }

  int fstat(int descriptor, struct stat* status) noexcept override {
    return fails(descriptor) ? -1 : FileCalls::fstat(descriptor, status);
  }
  ssize_t pread(int descriptor, void* out, std::size_t bytes, off_t offset) noexcept override {
    return fails(descriptor) ? -1 : FileCalls::pread(descriptor, out, bytes, offset);
  }
  ssize_t pwrite(int descriptor, const void* in, std::size_t bytes,
                 off_t offset) noexcept override {
    return fails(descriptor) ? -1 : FileCalls::pwrite(descriptor, in, bytes, offset);
  }
  int fsync(int) noexcept override { return 0; }  // no test here simulates a power failure
  int fdatasync(int descriptor) noexcept override { return fails(descriptor) ? -1 : 0; }
  int flock(int descriptor, int operation) noexcept override {
    return fails(descriptor) ? -1 : FileCalls::flock(descriptor, operation);
  }

 private:
  bool fails(int descriptor) noexcept {
    if (count_++ != fail_at_) return false;
    std::error_code ignored;
    name_ = std::filesystem::read_symlink("/proc/self/fd/" + std::to_string(descriptor), ignored);
    errno = EIO;
    return true;
  }

  const int fail_at_;
  int count_ = 0;
  std::string name_;
};

TEST_F(ResumedBuildFiles, ReportsTheDirectoryThatFailed) {
  const storage::TemporaryDirectory elsewhere;
  write(sphere(2));
  options_.temp_directory = elsewhere / ".";
  work_ = options_.work_directory(output_);
  const auto index_of = [&](const std::string& name) {
    const auto is_in = [&name](const std::filesystem::path& folder) {
      return name.starts_with(std::filesystem::canonical(folder).string());
    };
    if (name.find(".work") != std::string::npos)
      return std::pair(BuildDirectory::kTemporary, work_);
    if (is_in(elsewhere / "."))
      return std::pair(BuildDirectory::kTemporary, options_.temp_directory);
    if (is_in(meshes_ / ".")) return std::pair(BuildDirectory::kInput, mesh_);
    return std::pair(BuildDirectory::kOutput, output_);
  };
  std::map<std::filesystem::path, int> failed;
  for (const bool anew : {true, false})
    for (int call = 0;; ++call) {
      if (anew) std::filesystem::remove_all(work_);
      FailingFile calls(call);
      const auto report = build(calls);
      if (calls.name().empty()) break;
      if (report) continue;
      EXPECT_EQ(recorder_.failed, index_of(calls.name())) << calls.name();
      ++failed[recorder_.failed->second];
    }
  EXPECT_EQ(failed.size(), 4u);
}

// Data that memory would hold is spilled, and space that is already taken is not required again.
TEST_F(ResumedBuildFiles, RequiresOnlyTheSpaceStillNeeded) {
  write(sphere(3));
  const storage::Bytes expected = whole();
  const auto size = MeshSize::estimate(mesh_);
  ASSERT_TRUE(size);
  BuildMemory memory = kLarge;
  memory.edge_bytes = 0;
  const auto needed = [&](std::uint64_t kept_bytes, bool matched) {
    const auto need =
        SpaceNeed::after_reading(*size, memory.with_checkpoint(), kept_bytes, matched);
    return need.temporary_bytes + need.output_bytes;
  };
  storage::FaultyCalls calls;
  const auto build_with = [&](std::uint64_t free_bytes) {
    calls.device = storage::device_with_free(free_bytes);
    const auto report = build(calls, memory);
    EXPECT_FALSE(recorder_.did(BuildPhase::kOrdering) && !report);
    return static_cast<bool>(report);
  };
  const std::pair shortage(BuildDirectory::kTemporary, output_.parent_path());
  EXPECT_FALSE(build_with(needed(0, false) - 1));
  EXPECT_EQ(recorder_.failed, shortage);
  EXPECT_TRUE(build_with(needed(0, false)));
  using Stop = std::pair<BuildPhase, std::uint64_t>;
  for (const auto& [phase, parts] :
       {Stop(BuildPhase::kMatching, 0), Stop(BuildPhase::kBuildingTree, 0),
        Stop(BuildPhase::kBuildingTree, 2)}) {
    std::filesystem::remove(output_);
    stop_in(phase, parts);
    const bool matched = phase != BuildPhase::kMatching;
    // The sorted triangles, and at least a page head for each chunk.
    const std::uint64_t surely_kept_bytes =
        size->triangles * Triangles::record_bytes(false) + parts * sizeof(PageHead);
    const std::uint64_t kept_bytes = std::filesystem::file_size(work_ / "spill");
    EXPECT_FALSE(build_with(needed(kept_bytes, matched) - 1));
    EXPECT_EQ(recorder_.failed, shortage);
    EXPECT_TRUE(build_with(needed(surely_kept_bytes, matched)));
    EXPECT_FALSE(recorder_.did(BuildPhase::kReading));
    EXPECT_EQ(built(), expected);
  }
}

// Counts the space taken by this build and by the builds it resumes.
TEST_F(ResumedBuildFiles, ReportsTemporaryBytes) {
  write(sphere(3));
  storage::FaultyCalls calls;
  const auto at_once = build(calls, kLarge);
  ASSERT_TRUE(at_once);
  const std::uint64_t triangle_bytes = at_once->header.model.triangle_count * (16 + 36);
  EXPECT_GT(at_once->temporary_bytes, triangle_bytes);
  std::filesystem::remove(output_);
  stop_in(BuildPhase::kBuildingMask, 2);
  const auto later = build(calls, kLarge);
  ASSERT_TRUE(later);
  EXPECT_FALSE(recorder_.did(BuildPhase::kReading));
  EXPECT_GT(later->temporary_bytes, triangle_bytes);
}

TEST_F(ResumedBuildFiles, KeepsTheCheckpointInTheTemporaryDirectory) {
  const storage::TemporaryDirectory elsewhere;
  write(sphere(2));
  const storage::Bytes expected = whole();
  options_.temp_directory = elsewhere / ".";
  work_ = options_.work_directory(output_);
  stop_in(BuildPhase::kBuildingTree);
  EXPECT_EQ(elsewhere.names(), Names{work_.filename()});
  EXPECT_NE(options_.work_directory(meshes_ / "model.ptree"), work_);
  expect_completed(expected);
  EXPECT_EQ(elsewhere.names(), Names{});
}

}  // namespace
}  // namespace planetree::octree
