// Mesh files with bad records, and files too large for 32 bits, are built and queried.

#include <fcntl.h>
#include <unistd.h>

#include <gtest/gtest.h>

#include <cstdint>
#include <fstream>
#include <limits>
#include <span>
#include <string>

#include "tests/differential/answer_checks.h"
#include "tests/octree/builder/mesh/mesh_formats.h"
#include "tests/octree/builder/mesh/mesh_recorder.h"
#include "tests/oracle/built_model.h"

namespace planetree::oracle {
namespace {

using octree::TemporaryFile;

// One bad record between two good ones, which keep their indices.
void expect_skipped(const std::string& obj) {
  const TemporaryFile file(obj, ".obj");
  BuiltModel model(file.path());
  const ModelInfo& info = model.model().info();
  EXPECT_EQ(info.triangles, 2U);
  EXPECT_EQ(info.skipped, 1U);
  EXPECT_EQ(info.first_skipped, 1U);
  const ClosestPoint first = model.closest_point({0.2, 0.2, 1}),
                     last = model.closest_point({0.2, 0.2, 9});
  EXPECT_EQ(first.triangle, 0U);
  EXPECT_EQ(first.distance, 1);
  EXPECT_EQ(last.triangle, 2U);
  EXPECT_EQ(last.distance, 1);
  expect_same_bits(first, model.closest_point({0.2, 0.2, 1}));
}

const std::string kVertices =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\n"
    "v 0 0 10\nv 1 0 10\nv 0 1 10\n";

TEST(StabilityInput, FaceWithAMissingVertexIsSkipped) {
  expect_skipped(kVertices + "f 1 2 3\nf 1 2 99\nf 4 5 6\n");
}

TEST(StabilityInput, FaceWithTwoCornersIsSkipped) {
  expect_skipped(kVertices + "f 1 2 3\nf 1 2\nf 4 5 6\n");
}

// In every format: an infinite vertex and, where the format has them, an index out of range and a
// face of two corners. The good faces keep their indices and are found.
TEST(StabilityInput, BadRecordsOfEveryFormatAreSkippedAndTheRestAnswers) {
  const float infinity = std::numeric_limits<float>::infinity();
  for (const octree::MeshFormat& format :
       octree::formats_that([](const octree::MeshFormat&) { return true; })) {
    octree::PlainMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {infinity, 0, 5}}, {}};
    mesh.vertices.insert(mesh.vertices.end(), {{0, 0, 10}, {1, 0, 10}, {0, 1, 10}});
    mesh.faces = {{0, 1, 3}, {0, 1, 2}};
    if (format.is_indexed) mesh.faces.push_back({0, 1, 4294967295});
    if (format.has_polygons) mesh.faces.push_back({0, 1});
    mesh.faces.push_back({4, 5, 6});
    const std::uint64_t last = mesh.faces.size() - 1;
    const TemporaryFile file(format.write(mesh, {}), format.extension);
    BuiltModel model(file.path());
    EXPECT_EQ(model.model().info().triangles, 2U) << format.name;
    EXPECT_EQ(model.model().info().skipped, last - 1) << format.name;
    EXPECT_EQ(model.model().info().first_skipped, 0U) << format.name;
    EXPECT_EQ(model.closest_point({0.25, 0.25, 1}).triangle, 1U) << format.name;
    EXPECT_EQ(model.closest_point({0.25, 0.25, 1}).distance, 1) << format.name;
    EXPECT_EQ(model.closest_point({0.25, 0.25, 9}).triangle, last) << format.name;
    EXPECT_EQ(model.closest_point({0.25, 0.25, 9}).distance, 1) << format.name;
  }
}

// In a binary file a vertex may be NaN or infinite.
TEST(StabilityInput, NonFiniteVertexIsSkipped) {
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    const Soup triangles{{Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 1, 0}},
                         {Vec3{0, 0, 5}, Vec3{bad, 0, 5}, Vec3{0, 1, 5}},
                         {Vec3{0, 0, 10}, Vec3{1, 0, 10}, Vec3{0, 1, 10}}};
    BuiltModel model(triangles);
    EXPECT_EQ(model.model().info().skipped, 1U);
    EXPECT_EQ(model.model().info().first_skipped, 1U);
    EXPECT_EQ(model.closest_point({0.2, 0.2, 5}).triangle, 0U);
    EXPECT_EQ(model.closest_point({0.2, 0.2, 9}).triangle, 2U);
  }
}

// A PLY whose vertices end 52 GB into the file, mostly as holes of a sparse file. Some of the
// faces' indices fit unsigned numbers only.
class SparseMesh {
 public:
  SparseMesh() : file_("", ".ply"), descriptor_(::open(file_.path().c_str(), O_RDWR | O_CLOEXEC)) {
    const std::string head =
        "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(kVertices) +
        "\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 2\nproperty list uchar uint vertex_indices\nend_header\n";
    octree::Bytes faces;
    faces.put(std::uint8_t{3}, kIndices[0], kIndices[1], kIndices[2]);
    faces.put(std::uint8_t{3}, kIndices[3], kIndices[2], kIndices[1]);
    const std::uint64_t faces_begin = head.size() + 12 * kVertices;
    write(0, head);
    for (std::size_t i = 0; i < 4; ++i)
      write(head.size() + std::uint64_t{12} * kIndices[i],
            octree::Bytes().put(kCorners[i][0], kCorners[i][1], kCorners[i][2]).str());
    write(faces_begin, faces.str());
  }
  ~SparseMesh() { ::close(descriptor_); }

  static constexpr std::uint64_t kVertices = (std::uint64_t{1} << 32) - 5;
  static constexpr std::uint32_t kIndices[] = {2147483648U, 3000000000U, 4294967290U, 7U};
  static constexpr float kCorners[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 3}};

  [[nodiscard]] bool ok() const { return ok_; }
  [[nodiscard]] const std::filesystem::path& path() const { return file_.path(); }

 private:
  void write(std::uint64_t offset, const std::string& bytes) {
    ok_ &= ::pwrite(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(offset)) ==
           static_cast<ssize_t>(bytes.size());
  }

  TemporaryFile file_;
  int descriptor_;
  bool ok_ = true;
};

TEST(StabilityInput, OffsetsPast32BitsAndIndicesPast31) {
  const SparseMesh mesh;
  ASSERT_TRUE(mesh.ok()) << "the temporary folder's file system has no sparse files of 52 GB";
  BuiltModel model(mesh.path());
  EXPECT_EQ(model.model().info().vertices, SparseMesh::kVertices);
  EXPECT_EQ(model.model().info().triangles, 2U);
  EXPECT_EQ(model.closest_point({-3, -4, 0}).distance, 5);
  EXPECT_EQ(model.closest_point({-3, -4, 0}).triangle, 0U);
  EXPECT_EQ(model.closest_point({1, 1, 5}).distance, 2);
  EXPECT_EQ(model.closest_point({1, 1, 5}).triangle, 1U);
}

}  // namespace
}  // namespace planetree::oracle
