#include "octree/builder/mesh/mesh_reader.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cstdint>

#include "tests/octree/builder/mesh/mesh_recorder.h"

namespace planetree::octree {
namespace {

const std::string kTriangleLog = "0: 0 0 0, 1 0 0, 0 1 0\n";
const std::string kObj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

TEST(MeshReader, PrefersContentOverExtension) {
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
      "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
      "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  const std::string stl =
      "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n"
      "endfacet\nendsolid\n";
  const std::string off = "# of three corners\nOFF\n3 1 3\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  for (const std::string extension : {"", ".ply", ".stl", ".obj", ".off", ".txt"}) {
    EXPECT_EQ(read_bytes(ply, extension).log, kTriangleLog) << extension;
    EXPECT_EQ(read_bytes(stl, extension).log, kTriangleLog) << extension;
    EXPECT_EQ(read_bytes(off, extension).log, kTriangleLog) << extension;
  }
  EXPECT_EQ(read_bytes(kObj, ".obj").log, kTriangleLog);
  EXPECT_EQ(read_bytes(kObj, ".OBJ").log, kTriangleLog);
}

TEST(MeshReader, RefusesUnknownFormats) {
  for (const std::string extension : {"", ".ply", ".txt"}) {
    const Reading reading = read_bytes(kObj, extension);
    EXPECT_EQ(reading.code, ErrorCode::kBadInput);
    EXPECT_EQ(reading.error,
              "byte 0: neither a PLY, an STL, an OFF nor a glTF, and not named .obj; give a PLY, "
              "STL, OBJ, OFF or glTF mesh (an OBJ needs its extension)");
  }
  EXPECT_EQ(read_bytes("", ".ply").code, ErrorCode::kBadInput);
  EXPECT_EQ(read_bytes("ply", ".ply").code, ErrorCode::kBadInput);
}

TEST(MeshReader, RefusesPathsItCannotRead) {
  const std::filesystem::path folder = std::filesystem::temp_directory_path();
  const Reading missing = read_path(folder / "planetree_no_such_mesh.ply");
  EXPECT_EQ(missing.code, ErrorCode::kNotFound);
  EXPECT_EQ(missing.error, "no such file; check the path");
  const Reading directory = read_path(folder);
  EXPECT_EQ(directory.code, ErrorCode::kBadInput);
  EXPECT_NE(directory.error.find("not a regular file"), std::string::npos);
  const TemporaryFile taken("", ".fifo");
  std::filesystem::remove(taken.path());
  ASSERT_EQ(::mkfifo(taken.path().c_str(), 0600), 0);
  EXPECT_EQ(read_path(taken.path()).code, ErrorCode::kBadInput);
}

TEST(MeshReader, ReturnsTheSinksErrorAtOnce) {
  const TemporaryFile file(kObj + "v 1 1 0\nf 1 2 3 4\nf 3 2 1\n", ".obj");
  RecordingSink recorder;
  recorder.refuse_index = 1;
  const Result<MeshSummary> summary = read_mesh(file.path(), recorder);
  ASSERT_FALSE(summary);
  EXPECT_EQ(summary.error().code, ErrorCode::kNoSpace);
  EXPECT_EQ(recorder.log, kTriangleLog + "1: 0 0 0, 1 0 0, 0 1 0\n");
}

/// A binary STL of `count` facets. Each facet's coordinates encode its index.
std::string large_stl(std::uint32_t count) {
  Bytes bytes;
  bytes.text(std::string(80, '\0')).put(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    bytes.put(0.0F, 0.0F, 0.0F).put(static_cast<float>(i), 0.0F, 0.0F);
    bytes.put(0.0F, 1.0F, 0.0F).put(0.0F, 0.0F, 1.0F).put(std::uint16_t{0});
  }
  return bytes.str();
}

TEST(MeshReader, ReportsProgressAboutEveryFourMebibytes) {
  constexpr std::uint32_t kCount = 200000;
  constexpr std::uint64_t kBytes = 84 + 50 * std::uint64_t{kCount};
  const TemporaryFile file(large_stl(kCount), ".stl");
  RecordingSink recorder;
  ASSERT_TRUE(read_mesh(file.path(), recorder));
  ASSERT_EQ(recorder.reports.size(), 3U);
  std::uint64_t last = 0;
  for (const auto& [done, total] : recorder.reports) {
    EXPECT_EQ(total, kBytes);
    EXPECT_GT(done, last);
    EXPECT_LE(done - last, (std::uint64_t{4} << 20) + 50);
    last = done;
  }
  EXPECT_EQ(last, kBytes);
}

/// Counts triangles and sums x of their first corners.
class Summer : public TriangleSink {
 public:
  Result<void> triangle(std::uint64_t, const std::array<Vec3, 3>& corners) override {
    sum += corners[0].x;
    ++count;
    return {};
  }
  void skipped(std::uint64_t, std::uint64_t, const SkippedRecord&) override {}
  Result<void> progress(std::uint64_t, std::uint64_t) override { return {}; }

  double sum = 0;
  std::uint64_t count = 0;
};

TEST(MeshReader, ReadsTheSameWithAnyMemory) {
  constexpr std::uint32_t kCount = 20000;
  const TemporaryFile file(large_stl(kCount), ".stl");
  for (const std::uint64_t memory_bytes : {0, 1, 1 << 17}) {
    Summer summer;
    MeshScratch scratch(memory_bytes);
    ASSERT_TRUE(read_mesh(file.path(), summer, scratch));
    EXPECT_EQ(summer.count, kCount);
    EXPECT_EQ(summer.sum, kCount * (kCount - 1.0) / 2);
  }
}

}  // namespace
}  // namespace planetree::octree
