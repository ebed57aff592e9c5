// Builds that are stopped and resumed.

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <string>

#include "storage/spill/work_directory.h"
#include "tests/octree/builder/mesh/gltf/gltf_writer.h"
#include "tests/octree/builder/resumed_build.h"

namespace planetree::octree {
namespace {

const std::string kNoCheckpoint = "no checkpoint; building from the start";

TEST_F(ResumedBuild, WritesTheSameBytesAndLeavesNoOtherFiles) {
  for (const Soup& soup : {sphere(3), holed(), repeated(300)}) {
    write(soup);
    expect_completed(whole());
    EXPECT_EQ(recorder_.start, kNoCheckpoint);
    std::filesystem::remove(output_);
  }
}

TEST_F(ResumedBuild, ResumesAfterAStopAtAnyCall) {
  for (const Soup& soup : {sphere(2), holed()}) {
    write(soup);
    const storage::Bytes expected = whole();
    std::map<BuildPhase, std::uint64_t> resumed;
    for (int call = 0; stop_at(call); ++call) {
      SCOPED_TRACE("stopped at call " + std::to_string(call));
      const BuildRecorder stopped = recorder_;
      if (!resume_and_remove(expected)) continue;
      // Completed phases are not repeated, nor are parts that were counted.
      EXPECT_FALSE(stopped.did(BuildPhase::kMatching) && recorder_.did(BuildPhase::kReading));
      EXPECT_FALSE(stopped.did(BuildPhase::kBuildingTree) && recorder_.did(BuildPhase::kMatching));
      for (const BuildPhase phase : {BuildPhase::kBuildingTree, BuildPhase::kBuildingMask}) {
        const std::uint64_t before = recorder_.count(phase).resumed;
        EXPECT_GE(before, std::max(stopped.count(phase).done, resumed[phase]));
        resumed[phase] = before;
      }
    }
    EXPECT_EQ(resumed[BuildPhase::kBuildingTree], recorder_.count(BuildPhase::kBuildingTree).total);
    EXPECT_EQ(resumed[BuildPhase::kBuildingMask], recorder_.count(BuildPhase::kBuildingMask).total);
    std::filesystem::remove(output_);
  }
}

// The compressed file is what is compared with the input of the earlier build.
TEST_F(ResumedBuild, ResumesACompressedMesh) {
  write(sphere(2));
  const storage::Bytes expected = whole();
  const std::string command =
      "gzip --force " + mesh_.string() + " && mv " + mesh_.string() + ".gz " + mesh_.string();
  ASSERT_EQ(std::system(command.c_str()), 0);
  EXPECT_EQ(whole(), expected);
  int resumed = 0;
  for (int call = 0; stop_at(call); call += 3) {
    SCOPED_TRACE("stopped at call " + std::to_string(call));
    const BuildRecorder stopped = recorder_;
    if (!resume_and_remove(expected)) continue;
    EXPECT_FALSE(stopped.did(BuildPhase::kMatching) && recorder_.did(BuildPhase::kReading));
    ++resumed;
  }
  EXPECT_GT(resumed, 0);
}

TEST_F(ResumedBuild, ResumesWithARegion) {
  write(sphere(2));
  options_.box = {{-2, -2, 0.1}, {0.3, 2, 2}};
  const storage::Bytes expected = whole();
  int matched_before = 0;
  for (int call = 0; stop_at(call); call += 3) {
    SCOPED_TRACE("stopped at call " + std::to_string(call));
    const BuildRecorder stopped = recorder_;
    if (!resume_and_remove(expected)) continue;
    EXPECT_FALSE(stopped.did(BuildPhase::kBuildingTree) && recorder_.did(BuildPhase::kMatching));
    matched_before += !recorder_.did(BuildPhase::kMatching);
  }
  EXPECT_GT(matched_before, 3);
}

TEST_F(ResumedBuild, RestartsWithAnotherRegion) {
  write(sphere(2));
  options_.box = {{-2, -2, 0.1}, {0.3, 2, 2}};
  stop_in(BuildPhase::kBuildingTree);
  options_.box->upper.x = 0.4;
  ASSERT_TRUE(build());
  EXPECT_EQ(recorder_.start,
            "the checkpoint cannot be resumed: the options have changed; building from the start");
}

// One call fails, is interrupted or returns early. The process survives.
TEST_F(ResumedBuild, WritesTheSameBytesAfterAnyFault) {
  write(sphere(2));
  const storage::Bytes expected = whole();
  for (const Fault fault : {Fault::kError, Fault::kInterrupt, Fault::kShort})
    for (int call = 0;; call += 7) {
      SCOPED_TRACE("call " + std::to_string(call));
      storage::FaultyCalls calls;
      calls.fault = fault;
      calls.fault_at = call;
      const auto report = build(calls);
      if (!calls.happened()) break;
      EXPECT_TRUE(report || fault == Fault::kError) << report.error().text;
      if (report) {
        ASSERT_EQ(built(), expected);
      }
      expect_completed(expected);
      std::filesystem::remove(output_);
    }
}

// The build is stopped after a number of calls that any part takes fewer of. The whole build takes
// many more.
TEST_F(ResumedBuild, CompletesDespiteRepeatedStops) {
  write(sphere(3));
  const storage::Bytes expected = whole();
  int stops = 0;
  for (; stop_at(1200 + 50 * stops); ++stops)
    EXPECT_FALSE(stops > 0 && recorder_.did(BuildPhase::kReading));
  EXPECT_GE(stops, 3);
  EXPECT_EQ(built(), expected);
  EXPECT_EQ(folder_.names(), Names{"model.ptree"});
}

TEST_F(ResumedBuild, ResumesAfterKill) {
  write(sphere(2));
  const storage::Bytes expected = whole();
  std::map<std::string, int> starts;
  for (int call = 0;; call += 13) {
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      storage::FaultyCalls calls;
      calls.fault = Fault::kKill;
      calls.fault_at = call;
      ::_exit(build(calls) ? 0 : 1);
    }
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    if (!WIFSIGNALED(status)) break;
    expect_completed(expected);
    for (const char* phase : {"start", "ordering", "tree", "mask"})
      if (recorder_.start.find(phase) != std::string::npos) ++starts[phase];
    std::filesystem::remove(output_);
  }
  EXPECT_EQ(starts.size(), 4u);
}

TEST_F(ResumedBuild, ResumesWithOtherMemoryAndThreads) {
  write(sphere(3));
  const storage::Bytes expected = whole();
  for (const BuildPhase phase : {BuildPhase::kMatching, BuildPhase::kBuildingMask}) {
    stop_in(phase);
    ASSERT_TRUE(build(storage::FileCalls::real(), kBetween));
    EXPECT_FALSE(recorder_.did(BuildPhase::kReading));
    EXPECT_EQ(built(), expected);
    std::filesystem::remove(output_);
  }
}

TEST_F(ResumedBuild, RestartsIfTheInputChanged) {
  write(sphere(2));
  stop_in(BuildPhase::kBuildingMask, 4);
  Soup other = sphere(2);
  other[50][1].x *= 1.5;
  write(other);
  expect_completed(whole());
  EXPECT_EQ(recorder_.start,
            "the checkpoint cannot be resumed: the input has changed; building from the start");
}

// The file of the buffers has other positions, and the glTF is the same.
TEST_F(ResumedBuild, RestartsIfAFileBesideTheInputChanged) {
  const auto write_scene = [this](const Soup& soup) {
    GltfWriter scene;
    std::vector<Position> corners;
    for (const auto& triangle : soup)
      for (const Vec3& corner : triangle)
        corners.push_back({static_cast<float>(corner.x), static_cast<float>(corner.y),
                           static_cast<float>(corner.z)});
    scene.mesh({scene.primitive(scene.positions(corners))});
    std::ofstream(meshes_ / "model.bin", std::ios::binary) << scene.buffer.str();
    return scene.beside("model.bin");
  };
  std::ofstream(mesh_, std::ios::binary) << write_scene(sphere(2));
  stop_in(BuildPhase::kBuildingMask, 4);
  Soup other = sphere(2);
  other[50][1].x *= 1.5;
  write_scene(other);
  expect_completed(whole());
  EXPECT_EQ(recorder_.start,
            "the checkpoint cannot be resumed: the input has changed; building from the start");
}

TEST_F(ResumedBuild, NamesAMissingFileBesideTheInput) {
  GltfWriter scene;
  scene.mesh({scene.primitive(scene.positions({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}))});
  std::ofstream(mesh_, std::ios::binary) << scene.beside("model.bin");
  const auto report = build();
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().code, ErrorCode::kNotFound);
  EXPECT_NE(std::string(report.error().text).find("model.bin"), std::string::npos)
      << report.error().text;
}

TEST_F(ResumedBuild, RestartsIfTheOptionsChanged) {
  write(sphere(2));
  stop_in(BuildPhase::kBuildingMask, 4);
  options_.page_bytes = 8192;
  expect_completed(whole());
  EXPECT_EQ(recorder_.start,
            "the checkpoint cannot be resumed: the options have changed; building from the start");
  std::filesystem::remove(output_);
  stop_in(BuildPhase::kBuildingMask, 4);
  options_.keep = kKeepTriangles;
  expect_completed(whole());
  EXPECT_EQ(recorder_.start,
            "the checkpoint cannot be resumed: the options have changed; building from the start");
}

TEST_F(ResumedBuild, AllowsOneProcessAtATime) {
  write(sphere(2));
  const storage::Bytes expected = whole();
  stop_in(BuildPhase::kBuildingTree);
  {
    const auto other = storage::WorkDirectory::open(work_);
    ASSERT_TRUE(other);
    const auto report = build();
    ASSERT_FALSE(report);
    EXPECT_EQ(report.error().code, ErrorCode::kAlreadyExists);
  }
  expect_completed(expected);
  EXPECT_FALSE(recorder_.did(BuildPhase::kReading));
}

}  // namespace
}  // namespace planetree::octree
