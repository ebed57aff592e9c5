// The independent reader finds in the samples the meshes they were built from.

#include "tests/golden/spec_reader.h"
#include "planetree/layers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "planetree/planetree.h"
#include "tests/golden/samples.h"
#include "tests/golden/spec_mask.h"
#include "tests/golden/spec_tree.h"

namespace planetree::golden {
namespace {

class SpecReader : public testing::TestWithParam<Sample> {};

INSTANTIATE_TEST_SUITE_P(All, SpecReader, testing::ValuesIn(samples()), sample_name);

SpecTree open_tree(const Sample& sample) {
  return SpecTree(SpecFile(read_file(sample.ptree_path())));
}

// Compares bits, so that -0 differs from 0.
bool is_same(const SpecPoint& found, const Vec3& expected, int scale_exponent) {
  const double back[3] = {std::ldexp(found[0], -scale_exponent),
                          std::ldexp(found[1], -scale_exponent),
                          std::ldexp(found[2], -scale_exponent)};
  return std::memcmp(back, &expected, sizeof back) == 0;
}

TEST_P(SpecReader, FindsTheMeshExactly) {
  const SpecTree tree = open_tree(GetParam());
  const SpecHeader& header = tree.header();
  std::vector<SpecTriangle> found = tree.triangles(header.root_link());
  std::ranges::sort(found, {}, &SpecTriangle::id);
  const std::vector<MeshTriangle> expected = mesh_triangles(GetParam().mesh_path());
  ASSERT_EQ(found.size(), expected.size());
  ASSERT_EQ(found.size(), header.triangle_count);
  for (std::size_t i = 0; i < found.size(); ++i) {
    ASSERT_EQ(found[i].id, expected[i].id);
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_TRUE(is_same(found[i].corners[k], expected[i].corners[k], header.scale_exponent))
          << "triangle " << found[i].id << ", corner " << k;
  }
}

TEST_P(SpecReader, FindsBoxAndSampleInTheMesh) {
  const SpecHeader header = open_tree(GetParam()).header();
  const std::vector<MeshTriangle> mesh = mesh_triangles(GetParam().mesh_path());
  SpecPoint lower{}, upper{};
  lower.fill(INFINITY);
  upper.fill(-INFINITY);
  for (const MeshTriangle& triangle : mesh)
    for (const Vec3& corner : triangle.corners) {
      const SpecPoint point = {corner.x, corner.y, corner.z};
      for (std::size_t axis = 0; axis < 3; ++axis) {
        lower[axis] = std::min(lower[axis], point[axis]);
        upper[axis] = std::max(upper[axis], point[axis]);
      }
    }
  EXPECT_EQ(header.box_lower, lower);
  EXPECT_EQ(header.box_upper, upper);
  EXPECT_EQ(header.sample_triangle, mesh.front().id);
  EXPECT_TRUE(is_same(header.sample, mesh.front().corners[0], header.scale_exponent));
  double longest = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double low = std::ldexp(lower[axis], header.scale_exponent);
    const double high = std::ldexp(upper[axis], header.scale_exponent);
    EXPECT_EQ(header.centre[axis], (low + high) * 0.5);
    longest = std::max(longest, high - low);
  }
  EXPECT_GE(longest, 1);
  EXPECT_LT(longest, 2);
}

// The area vectors and their lengths, summed from the mesh.
TEST_P(SpecReader, FindsHowOpenTheMeshIs) {
  const SpecHeader header = open_tree(GetParam()).header();
  double sum[3] = {}, area = 0;
  for (const MeshTriangle& triangle : mesh_triangles(GetParam().mesh_path())) {
    const auto& [a, b, c] = triangle.corners;
    const double u[3] = {b.x - a.x, b.y - a.y, b.z - a.z}, v[3] = {c.x - a.x, c.y - a.y, c.z - a.z};
    const double vector[3] = {(u[1] * v[2] - u[2] * v[1]) / 2, (u[2] * v[0] - u[0] * v[2]) / 2,
                              (u[0] * v[1] - u[1] * v[0]) / 2};
    for (std::size_t axis = 0; axis < 3; ++axis) sum[axis] += vector[axis];
    area += std::hypot(vector[0], vector[1], vector[2]);
  }
  EXPECT_NEAR(header.openness, std::hypot(sum[0], sum[1], sum[2]) / area, 1e-12);
  EXPECT_EQ(header.by_surface, header.open() && header.openness >= 0.375);
  EXPECT_FALSE(header.side_is_chosen);
}

// Reader and library share no code, so their rounding may differ in the last bits.
TEST_P(SpecReader, AgreesWithTheLibrary) {
  const SpecTree tree = open_tree(GetParam());
  const auto model = Model::open(GetParam().ptree_path());
  ASSERT_TRUE(model) << model.error().text;
  auto probe = Probe::create(*model);
  ASSERT_TRUE(probe) << probe.error().text;
  const SpecHeader& header = tree.header();
  std::mt19937_64 random(20240229);
  for (int i = 0; i < 500; ++i) {
    SpecPoint point{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double edge = header.box_upper[axis] - header.box_lower[axis];
      const double share = static_cast<double>(random() >> 11) * 0x1p-53;
      point[axis] = header.box_lower[axis] + edge * (2 * share - 0.5);
    }
    const ClosestPoint answer = probe->closest_point({point[0], point[1], point[2]});
    for (double& coordinate : point) coordinate = std::ldexp(coordinate, header.scale_exponent);
    const SpecNearest nearest = tree.nearest(point);
    EXPECT_EQ(answer.status, Status::kExact);
    EXPECT_NEAR(nearest.distance, std::ldexp(answer.distance, header.scale_exponent), 1e-13);
  }
}

TEST(SpecReaderFile, UsesTheLastHeaderWhenTheFirstIsDamaged) {
  std::vector<std::byte> bytes = read_file(samples().front().ptree_path());
  bytes[100] ^= std::byte{1};
  EXPECT_EQ(SpecFile(bytes).header().triangle_count, 4u);
  bytes[bytes.size() - 100] ^= std::byte{1};
  EXPECT_THROW(SpecFile{bytes}, std::runtime_error);
}

void read_all(const std::vector<std::byte>& bytes) {
  const SpecFile file(bytes);
  const SpecTree tree(file);
  const SpecMask mask(file);
}

// A hash or check covers every byte. Only the header has a second copy.
TEST(SpecReaderFile, DetectsEveryDamagedByteOutsideTheHeaders) {
  const std::vector<std::byte> whole = read_file(samples().front().ptree_path());
  for (std::size_t at = 1024; at + 1024 < whole.size(); ++at) {
    std::vector<std::byte> bytes = whole;
    bytes[at] ^= std::byte{0x10};
    EXPECT_THROW(read_all(bytes), std::runtime_error) << at;
  }
}

// "Layout": files without some layers.
SpecFile file_with(const Sample& sample, std::uint32_t layers) {
  return SpecFile(build_bytes(sample.mesh_path(), 4096, 1, {}, layers));
}

TEST(SpecLayers, ThatAreLeftOutHaveNoPages) {
  for (const Sample& sample : samples()) {
    const SpecFile whole(read_file(sample.ptree_path()));
    const SpecFile file = file_with(sample, kDistanceLayer);
    EXPECT_FALSE(whole.header().without_sides);
    EXPECT_TRUE(file.header().without_sides);
    EXPECT_EQ(file.header().page_count, whole.header().c());
    EXPECT_EQ(file.header().c(), file.header().page_count);
    EXPECT_EQ(file.header().cap_count, 0u);
    EXPECT_EQ(file.header().mask_cells, 0u);
    EXPECT_EQ(file.header().field_pages, 0u);
    EXPECT_EQ(file.header().unbalanced_edges, whole.header().unbalanced_edges);
    EXPECT_EQ(file.header().openness, whole.header().openness);
    EXPECT_EQ(file.header().by_surface, whole.header().by_surface);
    EXPECT_FALSE(file_with(sample, kSideLayer).header().without_sides);
  }
}

TEST(SpecLayers, DoNotChangeTheTree) {
  for (const Sample& sample : samples()) {
    const SpecTree whole(SpecFile(read_file(sample.ptree_path())));
    const SpecTree tree(file_with(sample, kDistanceLayer));
    const auto expected = whole.triangles(whole.header().root_link());
    const auto found = tree.triangles(tree.header().root_link());
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
      EXPECT_EQ(found[i].id, expected[i].id);
      EXPECT_EQ(found[i].corners, expected[i].corners);
    }
  }
}

TEST(SpecMetadata, IsLinesOfTextBehindThePages) {
  const SpecFile file(read_file(painted_sample().ptree_path()));
  EXPECT_EQ(file.extension("metadata"),
            "crs: EPSG:25832\ntitle: Drum \u00d8 2 mm\nunit: mm\nup: z\n");
  const auto model = Model::open(painted_sample().ptree_path());
  ASSERT_TRUE(model);
  EXPECT_EQ(*model->metadata(), painted_sample().metadata);
  EXPECT_EQ(SpecFile(read_file(sphere_sample().ptree_path())).extension("metadata"), "");
  EXPECT_TRUE(Model::open(sphere_sample().ptree_path())->metadata()->empty());
}

}  // namespace
}  // namespace planetree::golden
