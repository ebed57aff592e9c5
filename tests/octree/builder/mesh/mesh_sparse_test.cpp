// Meshes with offsets beyond 32 bits: sparse files with bytes where the readers look.

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdint>

#include "tests/octree/builder/mesh/mesh_recorder.h"

namespace planetree::octree {
namespace {

constexpr char kNoSpace[] = "the temporary folder's file system has no sparse files of such a size";
// Less memory than the vertices need.
constexpr std::uint64_t kMemoryBytes[] = {MeshScratch::kMemoryBytes, std::uint64_t{1} << 20};

/// A sparse file with bytes at chosen offsets.
class SparseFile {
 public:
  explicit SparseFile(std::uint64_t size_bytes) : file_("", "") {
    descriptor_ = ::open(file_.path().c_str(), O_RDWR | O_CLOEXEC);
    ok_ = ::ftruncate(descriptor_, static_cast<off_t>(size_bytes)) == 0;
  }
  ~SparseFile() { ::close(descriptor_); }
  void write(std::uint64_t offset, const std::string& bytes) {
    const auto size = static_cast<ssize_t>(bytes.size());
    ok_ &= ::pwrite(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(offset)) == size;
  }
  [[nodiscard]] bool ok() const { return ok_; }
  [[nodiscard]] const std::filesystem::path& path() const { return file_.path(); }

 private:
  TemporaryFile file_;
  int descriptor_ = -1;
  bool ok_ = false;
};

TEST(SparseMesh, ReachesPlyIndicesPast31BitsAndOffsetsPast32) {
  constexpr std::uint64_t kVertexCount = (std::uint64_t{1} << 32) - 5;
  constexpr std::uint32_t kIndices[] = {2147483648U, 3000000000U, 4294967290U, 0U};
  const std::string head = "ply\nformat binary_little_endian 1.0\nelement vertex " +
                           std::to_string(kVertexCount) +
                           "\nproperty float x\nproperty float y\nproperty float z\n"
                           "element face 3\nproperty list uchar uint vertex_indices\nend_header\n";
  Bytes faces;
  faces.put(std::uint8_t{3}, kIndices[0], kIndices[1], kIndices[2]);
  faces.put(std::uint8_t{4}, kIndices[3], kIndices[2], kIndices[1], kIndices[0]);
  faces.put(std::uint8_t{3}, kIndices[0], kIndices[1], std::uint32_t{4294967291U});
  const std::uint64_t faces_begin = head.size() + 12 * kVertexCount;

  SparseFile file(faces_begin + faces.str().size());
  file.write(0, head);
  for (std::uint64_t i = 0; i < 4; ++i) {
    const float x = static_cast<float>(i + 1);
    file.write(head.size() + std::uint64_t{12} * kIndices[i],
               Bytes().put(x, 10 * x, 100 * x).str());
  }
  file.write(faces_begin, faces.str());
  if (!file.ok()) GTEST_SKIP() << kNoSpace;

  for (const std::uint64_t memory_bytes : kMemoryBytes) {
    const Reading reading = read_path(file.path(), memory_bytes);
    EXPECT_EQ(reading.error, "");
    EXPECT_EQ(reading.log,
              "0: 1 10 100, 2 20 200, 3 30 300\n"
              "1: 4 40 400, 3 30 300, 2 20 200\n"
              "2: 4 40 400, 2 20 200, 1 10 100\n"
              "3+1 aside: face 2: vertex index 4294967291 is out of range, the mesh has 4294967291 "
              "vertices\n");
    ASSERT_TRUE(reading.summary);
    EXPECT_EQ(reading.summary->vertex_records, kVertexCount);
  }
}

// The face takes 2^32 - 3 triangle indices, and the next face continues after them.
TEST(SparseMesh, SkipsAPlyFaceOfFourBillionCorners) {
  constexpr std::uint32_t kCorners = 4294967295U;
  const std::string head =
      "ply\nformat binary_big_endian 1.0\nelement vertex 3\n"
      "property float x\nproperty float y\nproperty float z\n"
      "element face 2\nproperty list uint uchar vertex_indices\nend_header\n";
  Bytes first(std::endian::big), last(std::endian::big);
  first.text(head).put_all<float>({1, 0, 0, 0, 1, 0, 0, 0, 1}).put(kCorners, std::uint8_t{3});
  last.put(std::uint32_t{3}).put_all<std::uint8_t>({0, 1, 2});
  const std::uint64_t last_begin = first.str().size() - 1 + kCorners;
  SparseFile file(last_begin + last.str().size());
  file.write(0, first.str());
  file.write(last_begin, last.str());
  if (!file.ok()) GTEST_SKIP() << kNoSpace;

  const Reading reading = read_path(file.path());
  EXPECT_EQ(reading.error, "");
  EXPECT_EQ(reading.log,
            "0+4294967293 aside: face 0: vertex index 3 is out of range, the mesh has 3 vertices\n"
            "4294967293: 1 0 0, 0 1 0, 0 0 1\n");
}

TEST(SparseMesh, ReachesTheLastVerticesOfABinaryOff) {
  using Int32 = std::int32_t;
  constexpr Int32 kVertexCount = 2147483647;
  constexpr Int32 kIndices[] = {2147483646, 1500000000, 357913942};
  Bytes head(std::endian::big), faces(std::endian::big);
  head.text("OFF BINARY\n").put(kVertexCount, Int32{2}, Int32{0});
  faces.put(Int32{3}, kIndices[0], kIndices[1], kIndices[2], Int32{0});
  faces.put(Int32{3}, kIndices[0], kIndices[1], kVertexCount, Int32{0});
  const std::uint64_t faces_begin = head.str().size() + std::uint64_t{12} * kVertexCount;
  SparseFile file(faces_begin + faces.str().size());
  file.write(0, head.str());
  float x = 1;
  for (const Int32 index : kIndices) {
    file.write(head.str().size() + std::uint64_t{12} * static_cast<std::uint64_t>(index),
               Bytes(std::endian::big).put(x, 10 * x, 100 * x).str());
    ++x;
  }
  file.write(faces_begin, faces.str());
  if (!file.ok()) GTEST_SKIP() << kNoSpace;

  for (const std::uint64_t memory_bytes : kMemoryBytes) {
    const Reading reading = read_path(file.path(), memory_bytes);
    EXPECT_EQ(reading.error, "");
    EXPECT_EQ(reading.log,
              "0: 1 10 100, 2 20 200, 3 30 300\n"
              "1+1 aside: face 1: vertex index 2147483647 is out of range, the mesh has 2147483647 "
              "vertices\n");
  }
}

TEST(SparseMesh, DetectsAnStlPast32BitsByItsSize) {
  constexpr std::uint32_t kFacets = 4294967295U;
  SparseFile file(84 + 50 * std::uint64_t{kFacets});
  file.write(80, Bytes().put(kFacets, 0.0F, 0.0F, 1.0F, 1.0F, 2.0F, 3.0F).str());
  if (!file.ok()) GTEST_SKIP() << kNoSpace;
  RecordingSink recorder;
  recorder.refuse_index = 1;  // the others would take minutes
  const auto summary = read_mesh(file.path(), recorder);
  ASSERT_FALSE(summary);
  EXPECT_EQ(summary.error().code, ErrorCode::kNoSpace);
  EXPECT_EQ(recorder.log, "0: 1 2 3, 0 0 0, 0 0 0\n1: 0 0 0, 0 0 0, 0 0 0\n");
}

TEST(SparseMesh, RefusesWrongStlCountsPast32Bits) {
  // Truncated to 32 bits these counts are 0 and 3.
  for (const std::uint64_t facets : {std::uint64_t{1} << 32, (std::uint64_t{1} << 32) + 3}) {
    const auto count_in_32_bits = static_cast<std::uint32_t>(facets);
    SparseFile file(84 + 50 * facets);
    file.write(80, Bytes().put(count_in_32_bits).str());
    if (!file.ok()) GTEST_SKIP() << kNoSpace;
    const Reading reading = read_path(file.path());
    EXPECT_EQ(reading.code, ErrorCode::kBadInput);
    EXPECT_EQ(reading.log, "");
  }
}

}  // namespace
}  // namespace planetree::octree
