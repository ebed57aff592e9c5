// Meshes read with little memory: in order, in random order, and truncated while they are read.

#include "octree/builder/mesh/stream/face_vertex_join.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <utility>

#include "tests/octree/builder/mesh/mesh_formats.h"

namespace planetree::octree {
namespace {

using Indices = std::vector<std::int64_t>;

/// A grid of squares, row by row, as triangles and other polygons.
PlainMesh height_field(unsigned side) {
  PlainMesh mesh;
  for (unsigned i = 0; i < side; ++i)
    for (unsigned j = 0; j < side; ++j)
      mesh.vertices.push_back(
          {static_cast<float>(i), static_cast<float>(j) / 3, static_cast<float>(i * j % 7)});
  const auto at = [side](unsigned i, unsigned j) { return std::int64_t{i} * side + j; };
  for (unsigned i = 0; i + 1 < side; ++i)
    for (unsigned j = 0; j + 1 < side; ++j) {
      if ((i + j) % 3 == 0) {
        mesh.faces.push_back({at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)});
      } else {
        mesh.faces.push_back({at(i, j), at(i, j + 1), at(i + 1, j)});
        mesh.faces.push_back({at(i + 1, j), at(i, j + 1), at(i + 1, j + 1)});
      }
    }
  return mesh;
}

/// The same faces and vertices, both in random order.
PlainMesh in_random_order(const PlainMesh& mesh) {
  std::mt19937 random(5);
  std::vector<std::size_t> order(mesh.vertices.size());
  std::iota(order.begin(), order.end(), 0);
  std::shuffle(order.begin(), order.end(), random);
  PlainMesh other = mesh;
  for (std::size_t i = 0; i < order.size(); ++i) other.vertices[order[i]] = mesh.vertices[i];
  for (Indices& face : other.faces)
    for (std::int64_t& index : face)
      index = static_cast<std::int64_t>(order[static_cast<std::size_t>(index)]);
  std::shuffle(other.faces.begin(), other.faces.end(), random);
  return other;
}

/// The mesh with unusable faces and two faces of very many corners, one of them bad.
PlainMesh damaged(PlainMesh mesh, std::size_t corners) {
  const std::size_t count = mesh.vertices.size();
  mesh.vertices[count / 2][1] = std::numeric_limits<float>::quiet_NaN();
  mesh.faces.insert(mesh.faces.begin() + 10, {1, 2});
  mesh.faces[30].push_back(static_cast<std::int64_t>(count));
  mesh.faces[50][0] = -1;
  std::mt19937 random(6);
  Indices many;
  for (std::size_t k = 0; k < corners; ++k)
    many.push_back(static_cast<std::int64_t>(random() % (count / 2)));
  mesh.faces.insert(mesh.faces.begin() + static_cast<std::ptrdiff_t>(mesh.faces.size()) / 2, many);
  many.back() = static_cast<std::int64_t>(count / 2);
  // Also after corners have started to be sorted.
  mesh.faces.push_back({2, 1});
  mesh.faces.push_back(many);
  mesh.faces.push_back({0, 1, 2});
  return mesh;
}

std::string join_name_of(const testing::TestParamInfo<MeshFormat>& info) { return info.param.name; }

class FaceVertexJoinOf : public testing::TestWithParam<MeshFormat> {
 protected:
  static std::string bytes_of(const PlainMesh& mesh) { return GetParam().write(mesh, {}); }
};
INSTANTIATE_TEST_SUITE_P(All, FaceVertexJoinOf,
                         testing::ValuesIn(formats_that([](const MeshFormat& format) {
                           return format.is_indexed;
                         })),
                         join_name_of);

TEST_P(FaceVertexJoinOf, DeliversTheSameWithAnyMemory) {
  for (const PlainMesh& mesh :
       {height_field(40), in_random_order(height_field(40)), damaged(height_field(40), 9000),
        damaged(in_random_order(height_field(40)), 9000)}) {
    const TemporaryFile file(bytes_of(mesh), GetParam().extension);
    MeshScratch enough;
    const Reading expected = read_path(file.path(), enough);
    ASSERT_TRUE(expected.summary) << expected.error;
    EXPECT_EQ(enough.disk_bytes(), 0u);
    for (const std::uint64_t memory_bytes : {0, 1, 1000, 5000, 30000}) {
      const Reading reading = read_path(file.path(), memory_bytes);
      ASSERT_TRUE(reading.summary) << reading.error;
      EXPECT_EQ(reading.log, expected.log);
      EXPECT_EQ(reading.summary->vertex_records, expected.summary->vertex_records);
      EXPECT_EQ(reading.summary->face_records, expected.summary->face_records);
      EXPECT_EQ(reading.summary->triangle_indices, expected.summary->triangle_indices);
    }
  }
}

TEST_P(FaceVertexJoinOf, SortsOnDiskOnlyWhenInRandomOrder) {
  constexpr std::uint64_t kMemoryBytes = 20000;
  const auto sorted_bytes = [](const PlainMesh& mesh) {
    const TemporaryFile file(bytes_of(mesh), GetParam().extension);
    MeshScratch scratch(kMemoryBytes);
    int sorts = 0;
    scratch.before_sorting([&] {
      ++sorts;
      return Result<void>();
    });
    const Reading reading = read_path(file.path(), scratch);
    EXPECT_EQ(reading.error, "");
    const std::uint64_t position_bytes = GetParam().is_text ? 24 : 12;
    const std::uint64_t text_bytes =
        GetParam().is_text ? mesh.vertices.size() * position_bytes - kMemoryBytes / 2 : 0;
    EXPECT_EQ(sorts == 0, scratch.disk_bytes() <= text_bytes);
    return sorts;
  };
  EXPECT_EQ(sorted_bytes(height_field(90)), 0);
  EXPECT_EQ(sorted_bytes(in_random_order(height_field(90))), 1);
}

TEST_P(FaceVertexJoinOf, ReportsProgressThatNeverDecreases) {
  const TemporaryFile file(bytes_of(in_random_order(height_field(400))), GetParam().extension);
  MeshScratch scratch(50000);
  RecordingSink recorder;
  ASSERT_TRUE(read_mesh(file.path(), recorder, scratch));
  ASSERT_GT(recorder.reports.size(), 2u);
  std::pair<std::uint64_t, std::uint64_t> last;
  for (const auto& [done, total] : recorder.reports) {
    EXPECT_GE(done, last.first);
    EXPECT_GE(total, last.second);
    EXPECT_LE(done, total);
    last = {done, total};
  }
  EXPECT_EQ(last.first, last.second);
  // Sorting is more than half as much work again as reading what fits in memory.
  RecordingSink unsorted;
  MeshScratch enough;
  ASSERT_TRUE(read_mesh(file.path(), unsorted, enough));
  EXPECT_GT(last.second, unsorted.reports.back().second / 2 * 3);
}

/// System calls that count the bytes read of one file and may truncate it.
class WatchedFile final : public storage::FileCalls {
 public:
  explicit WatchedFile(std::filesystem::path path) : path_(std::move(path)) {}
  std::uint64_t from = 0, to = ~std::uint64_t{0};  ///< range of bytes that are counted
  std::uint64_t cut_after = ~std::uint64_t{0};     ///< number of reads before the file is truncated

  std::uint64_t read_bytes() const { return read_bytes_; }
  std::uint64_t reads() const { return reads_; }

  int openat(int directory, const char* path, int flags, mode_t mode) noexcept override {
    const int opened = FileCalls::openat(directory, path, flags, mode);
    if (path == path_) descriptor_ = opened;
    return opened;
  }
  ssize_t pread(int descriptor, void* out, std::size_t bytes, off_t offset) noexcept override {
    if (descriptor == descriptor_) {
      if (reads_++ == cut_after && ::truncate(path_.c_str(), 100) != 0) std::abort();
      const auto begin = static_cast<std::uint64_t>(offset);
      if (begin < to && begin + bytes > from)
        read_bytes_ += std::min(begin + bytes, to) - std::max(begin, from);
    }
    return FileCalls::pread(descriptor, out, bytes, offset);
  }

 private:
  const std::filesystem::path path_;
  int descriptor_ = -1;
  std::uint64_t read_bytes_ = 0, reads_ = 0;
};

// In order, each vertex is read about once; in random order, a little more. The overhead does not
// grow with the mesh.
TEST(FaceVertexJoin, ReadsVerticesAboutOnce) {
  for (const unsigned side : {150u, 300u}) {
    const std::uint64_t vertex_bytes = std::uint64_t{side} * side * 12;
    for (const bool in_order : {true, false}) {
      const PlainMesh mesh = in_order ? height_field(side) : in_random_order(height_field(side));
      const std::string bytes = mesh_formats::ply_little(mesh, {});
      const TemporaryFile file(bytes, ".ply");
      WatchedFile calls(file.path());
      calls.from = bytes.find("end_header\n") + 11;
      calls.to = calls.from + vertex_bytes;
      constexpr std::uint64_t kMemoryBytes = 40000;
      MeshScratch scratch(kMemoryBytes, std::filesystem::temp_directory_path(), calls);
      RecordingSink recorder;
      ASSERT_TRUE(read_mesh(file.path(), recorder, scratch));
      EXPECT_GE(calls.read_bytes(), vertex_bytes);
      // The header is parsed from a prefix of 64 KiB, and the window reaches back a little.
      constexpr std::uint64_t kPrefixBytes = (64 + 8) << 10;
      const std::uint64_t jumps_bytes = in_order ? vertex_bytes / 16 : 4 * kMemoryBytes;
      EXPECT_LE(calls.read_bytes(), vertex_bytes + jumps_bytes + kPrefixBytes);
    }
  }
}

// The window moves along the faces. Nothing is read twice.
TEST(FaceVertexJoin, ReadsFacesOnce) {
  const PlainMesh mesh = height_field(300);
  const std::string bytes = mesh_formats::ply_little(mesh, {});
  const TemporaryFile file(bytes, ".ply");
  WatchedFile calls(file.path());
  calls.from = bytes.find("end_header\n") + 11 + mesh.vertices.size() * 12;
  MeshScratch scratch(100000, std::filesystem::temp_directory_path(), calls);
  RecordingSink recorder;
  ASSERT_TRUE(read_mesh(file.path(), recorder, scratch));
  EXPECT_EQ(calls.read_bytes(), bytes.size() - calls.from);
}

class MeshTruncatedWhileRead : public testing::TestWithParam<MeshFormat> {};
INSTANTIATE_TEST_SUITE_P(All, MeshTruncatedWhileRead,
                         testing::ValuesIn(formats_that([](const MeshFormat&) { return true; })),
                         join_name_of);

TEST_P(MeshTruncatedWhileRead, IsAnErrorAtAnyRead) {
  PlainMesh mesh = in_random_order(height_field(60));
  if (!GetParam().has_polygons)
    for (Indices& face : mesh.faces) face.resize(3);
  const std::string bytes = GetParam().write(mesh, {});
  std::uint64_t refused = 0;
  for (std::uint64_t cut_after = 0;; ++cut_after) {
    const TemporaryFile file(bytes, GetParam().extension);
    WatchedFile calls(file.path());
    calls.cut_after = cut_after;
    MeshScratch scratch(16000, std::filesystem::temp_directory_path(), calls);
    RecordingSink recorder;
    const auto summary = read_mesh(file.path(), recorder, scratch);
    if (calls.reads() <= cut_after) break;
    ASSERT_FALSE(summary);
    EXPECT_EQ(summary.error().code, ErrorCode::kBadInput);
    EXPECT_NE(std::string_view(summary.error().text).find(": the mesh became shorter while"),
              std::string_view::npos)
        << summary.error().text;
    ++refused;
    cut_after += cut_after / 8;
  }
  EXPECT_GE(refused, 2u);
}

TEST(FaceVertexJoin, ReportsTheErrorOfBeforeSorting) {
  const TemporaryFile file(mesh_formats::ply_big(in_random_order(height_field(90)), {}), ".ply");
  MeshScratch scratch(20000);
  scratch.before_sorting([]() -> Result<void> {
    return make_error(ErrorCode::kNoSpace, Error::kNowhere, Error::kNowhere, "no room");
  });
  const Reading reading = read_path(file.path(), scratch);
  EXPECT_EQ(reading.error, "no room");
  EXPECT_EQ(scratch.disk_bytes(), 0u);
}

}  // namespace
}  // namespace planetree::octree
