// Builds of several files that together are one mesh.

#include "tests/octree/builder/split_mesh.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

#include "tests/octree/builder/resumed_build.h"

namespace planetree::octree {
namespace {

class SplitMesh : public ResumedBuild {
 protected:
  SplitMesh() : soup_(with_short_numbers(sphere(3))), cuts_{70, 71, 200} {
    soup_.resize(soup_.size() - 9);
    options_.resume = false;
    options_.metadata["generator"] = "tests";
  }
  std::filesystem::path part(std::size_t number, const std::string& extension) const {
    return meshes_ / ("part-" + std::to_string(number) + extension).c_str();
  }
  // The bytes of a build of one file.
  storage::Bytes of_one(const std::filesystem::path& path) {
    mesh_ = path;
    parts_.clear();
    return whole_bytes();
  }
  storage::Bytes whole_bytes() {
    const auto report = build();
    EXPECT_TRUE(report) << report.error().text;
    storage::Bytes bytes = built();
    std::filesystem::remove(output_);
    return bytes;
  }
  void split_into_stl() {
    parts_.clear();
    for (const Soup& each : split(soup_, cuts_)) {
      parts_.push_back(part(parts_.size(), ".stl"));
      write(each, parts_.back());
    }
  }

  Soup soup_;
  const std::vector<std::size_t> cuts_;
};

TEST_F(SplitMesh, GivesTheBytesOfTheJoinedStl) {
  write(soup_, part(9, ".stl"));
  const auto expected = of_one(part(9, ".stl"));
  split_into_stl();
  ASSERT_EQ(parts_.size(), 4u);
  EXPECT_EQ(whole_bytes(), expected);
  parts_ = {part(9, ".stl")};
  EXPECT_EQ(whole_bytes(), expected);
}

TEST_F(SplitMesh, GivesTheBytesOfTheJoinedMeshInAnyFormats) {
  write(soup_, part(9, ".stl"));
  const auto expected = of_one(part(9, ".stl"));
  const auto soups = split(soup_, cuts_);
  write(soups[0], part(0, ".stl"));
  write_obj(soups[1], part(1, ".obj"));
  write_ply(soups[2], part(2, ".ply"));
  write_obj(soups[3], part(3, ".obj"));
  const std::string packed = part(3, ".obj").string();
  ASSERT_EQ(std::system(("gzip '" + packed + "'").c_str()), 0);
  parts_ = {part(0, ".stl"), part(1, ".obj"), part(2, ".ply"), part(3, ".obj.gz")};
  EXPECT_EQ(whole_bytes(), expected);
  for (const BuildMemory& memory : {kLarge, kBetween, kSortedOnDisk}) {
    storage::FaultyCalls calls;
    ASSERT_TRUE(build(calls, memory));
    EXPECT_EQ(built(), expected);
  }
}

TEST_F(SplitMesh, StoresDoublesIfOneFileNeedsThem) {
  soup_[250][1].x += 1e-12;
  write_obj(soup_, part(9, ".obj"));
  const auto expected = of_one(part(9, ".obj"));
  const auto soups = split(soup_, cuts_);
  for (std::size_t i = 0; i < 3; ++i) write(soups[i], part(i, ".stl"));
  write_ply(soups[3], part(3, ".ply"), 0, "int", "double");
  parts_ = {part(0, ".stl"), part(1, ".stl"), part(2, ".stl"), part(3, ".ply")};
  EXPECT_EQ(whole_bytes(), expected);
  // As for one file, the digits that a float does not have are read if that is wanted.
  write_ply(soups[3], part(3, ".ply"), 0, "int", "float");
  EXPECT_NE(whole_bytes(), expected);
  options_.float64 = true;
  EXPECT_EQ(whole_bytes(), expected);
}

TEST_F(SplitMesh, CountsSkippedRecordsOfEarlierFiles) {
  soup_[75][2].y = soup_[205][0].z = std::numeric_limits<double>::quiet_NaN();
  write(soup_, part(9, ".stl"));
  const auto expected = of_one(part(9, ".stl"));
  split_into_stl();
  const auto report = build();
  ASSERT_TRUE(report) << report.error().text;
  EXPECT_EQ(built(), expected);
  EXPECT_EQ(report->frame.first_skipped, 75u);
  EXPECT_EQ(report->frame.skipped_count, 2u);
  EXPECT_EQ(report->frame.first_skipped_text,
            parts_[2].string() + ": facet 4: corner 2 is not finite");
  options_.strict = true;
  const auto refused = build();
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::kBadInput);
  EXPECT_EQ(recorder_.failed, std::pair(BuildDirectory::kInput, parts_[2]));
}

TEST_F(SplitMesh, KeepsAttributesOfAllFiles) {
  options_.keep = kKeepTriangles | kKeepColor | kKeepValue;
  write_ply(soup_, part(9, ".ply"));
  const auto expected = of_one(part(9, ".ply"));
  std::size_t first = 0;
  for (const Soup& each : split(soup_, cuts_)) {
    parts_.push_back(part(parts_.size(), ".ply"));
    write_ply(each, parts_.back(), first);
    first += each.size();
  }
  EXPECT_EQ(whole_bytes(), expected);
  write_ply(split(soup_, cuts_)[2], parts_[2], 71, "double");
  const auto refused = build();
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::kBadInput);
  EXPECT_EQ(recorder_.failed, std::pair(BuildDirectory::kInput, parts_[2]));
}

TEST_F(SplitMesh, NamesTheFileOfAnError) {
  split_into_stl();
  std::filesystem::remove(parts_[1]);
  for (const bool resumes : {false, true}) {
    options_.resume = resumes;
    const auto refused = build();
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::kNotFound);
    EXPECT_EQ(recorder_.failed, std::pair(BuildDirectory::kInput, parts_[1]));
  }
  storage::write_bytes(parts_[1], storage::Bytes(100));
  const auto refused = build();
  ASSERT_FALSE(refused);
  EXPECT_EQ(recorder_.failed, std::pair(BuildDirectory::kInput, parts_[1]));
}

TEST_F(SplitMesh, IsResumedUnlessAFileChanged) {
  split_into_stl();
  const auto expected = whole();
  stop_in(BuildPhase::kBuildingTree, 2);
  expect_completed(expected);
  EXPECT_FALSE(recorder_.did(BuildPhase::kReading));
  std::filesystem::remove(output_);
  stop_in(BuildPhase::kBuildingTree, 2);
  storage::write_bytes(parts_[2], storage::read_bytes(parts_[2]));
  expect_completed(expected);
  EXPECT_EQ(recorder_.start,
            "the checkpoint cannot be resumed: input file 3 of 4 has changed; building from the "
            "start");
  std::filesystem::remove(output_);
  stop_in(BuildPhase::kBuildingTree, 2);
  parts_.pop_back();
  expect_completed(whole());
  EXPECT_EQ(recorder_.start,
            "the checkpoint cannot be resumed: the number of input files has changed; building "
            "from the start");
}

}  // namespace
}  // namespace planetree::octree
