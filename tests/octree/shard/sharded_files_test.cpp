// Shards of a mesh of several files.

#include <gtest/gtest.h>

#include <string>

#include "tests/octree/builder/split_mesh.h"
#include "tests/octree/shard/sharded_build.h"

namespace planetree::octree {
namespace {

class ShardedFiles : public ShardedBuild {
 protected:
  // Five files, of which one has most of the triangles, and a skipped record in another.
  void SetUp() override {
    Soup soup = with_short_numbers(sphere(3));
    soup.resize(soup.size() - 9);
    soup[300][1].x = std::numeric_limits<double>::quiet_NaN();
    write(soup);
    joined_ = whole();
    std::size_t first = 0;
    for (const Soup& each : split(soup, {10, 290, 310, 420})) {
      parts_.push_back(meshes_ / ("part-" + std::to_string(parts_.size()) + ".stl").c_str());
      write(each, parts_.back());
      first += each.size();
    }
    ASSERT_EQ(first, soup.size());
  }
  void expect_refused(const Result<ShardReport>& refused, const std::filesystem::path& file) {
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::kBadInput);
    EXPECT_NE(std::string(refused.error().text).find("the input has changed since"),
              std::string::npos)
        << refused.error().text;
    EXPECT_EQ(recorder_.failed, std::pair(BuildDirectory::kInput, file));
  }

  storage::Bytes joined_;
};

TEST_F(ShardedFiles, GiveTheBytesOfTheJoinedMesh) {
  expect_same({1, 2, 3, 7, 40});
  EXPECT_EQ(built(), joined_);
}

TEST_F(ShardedFiles, GiveTheBytesOfTheJoinedMeshWithStraysAndAttributes) {
  Soup soup = with_short_numbers(sphere(3));
  for (Vec3& corner : soup[400]) corner = {corner.x + 4e6, corner.y, corner.z - 3e6};
  options_.keep = kKeepTriangles | kKeepColor | kKeepValue;
  parts_.clear();
  mesh_ = meshes_ / "joined.ply";
  write_ply(soup, mesh_);
  const auto joined = whole();
  std::size_t first = 0;
  for (const Soup& each : split(soup, {33, 350})) {
    parts_.push_back(meshes_ / ("part-" + std::to_string(parts_.size()) + ".ply").c_str());
    write_ply(each, parts_.back(), first);
    first += each.size();
  }
  expect_same({1, 2, 3});
  EXPECT_EQ(built(), joined);
}

TEST_F(ShardedFiles, MapsReadOnlyTheFilesOfTheirPart) {
  ASSERT_TRUE(plan(3));
  const auto last = parts_[4];
  std::filesystem::rename(last, last.string() + ".away");
  const auto first_part = map(0);
  ASSERT_TRUE(first_part) << first_part.error().text;
  const std::uint64_t read = recorder_.count(BuildPhase::kReading).total;
  EXPECT_EQ(read, std::filesystem::file_size(parts_[0]) + std::filesystem::file_size(parts_[1]));
  const auto refused = map(2);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::kNotFound);
  EXPECT_EQ(recorder_.failed, std::pair(BuildDirectory::kInput, last));
  std::filesystem::rename(last.string() + ".away", last);
  std::filesystem::remove(parts_[0]);
  run_all_after_plan(3);
  EXPECT_EQ(built(), joined_);
}

TEST_F(ShardedFiles, MapsRefuseAFileThatChanged) {
  ASSERT_TRUE(plan(3));
  auto bytes = storage::read_bytes(parts_[3]);
  bytes[200] ^= std::byte{1};
  storage::write_bytes(parts_[3], bytes);
  expect_refused(map(1), parts_[3]);
  bytes.resize(bytes.size() + 50);
  storage::write_bytes(parts_[3], bytes);
  expect_refused(map(1), parts_[3]);
  ASSERT_TRUE(map(0));
}

TEST_F(ShardedFiles, TakeCopiesOfTheFiles) {
  ASSERT_TRUE(plan(2));
  for (const auto& path : parts_) storage::write_bytes(path, storage::read_bytes(path));
  run_all_after_plan(2);
  EXPECT_EQ(built(), joined_);
}

TEST_F(ShardedFiles, PlanAgainIfTheListDiffers) {
  const auto planned = plan(2);
  ASSERT_TRUE(planned);
  std::uint64_t bytes = 0;
  for (const auto& path : parts_) bytes += std::filesystem::file_size(path);
  EXPECT_EQ(planned->input_bytes, bytes);
  EXPECT_TRUE(plan(2)->was_done);
  std::swap(parts_[0], parts_[1]);
  const auto swapped = plan(2);
  ASSERT_TRUE(swapped);
  EXPECT_FALSE(swapped->was_done);
  parts_.pop_back();
  const auto fewer = plan(2);
  ASSERT_TRUE(fewer);
  EXPECT_FALSE(fewer->was_done);
}

TEST_F(ShardedFiles, PlanNamesTheFileOfAnError) {
  std::filesystem::remove(parts_[2]);
  const auto missing = plan(2);
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().code, ErrorCode::kNotFound);
  EXPECT_EQ(recorder_.failed, std::pair(BuildDirectory::kInput, parts_[2]));
  storage::write_bytes(parts_[2], storage::Bytes(100));
  ASSERT_FALSE(plan(2));
  EXPECT_EQ(recorder_.failed, std::pair(BuildDirectory::kInput, parts_[2]));
}

}  // namespace
}  // namespace planetree::octree
