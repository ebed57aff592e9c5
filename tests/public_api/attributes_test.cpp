// Triangles by their indices, and what files keep of them.

#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <limits>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "tests/public_api/meshes.h"

namespace planetree::public_api {
namespace {

bool are_equal(const Vec3& a, const Vec3& b) { return a.x == b.x && a.y == b.y && a.z == b.z; }

// A torus whose vertices and triangles have attributes that tell them apart.
struct Painted {
  Mesh mesh = torus(60, 40);
  std::vector<Color> colors;
  std::vector<TextureCoordinate> uvs;
  std::vector<std::uint64_t> values;

  Painted() {
    for (std::uint32_t i = 0; i < mesh.vertices.size(); ++i) {
      colors.push_back({static_cast<std::uint8_t>(i), static_cast<std::uint8_t>(i / 7),
                        static_cast<std::uint8_t>(i / 256),
                        static_cast<std::uint8_t>(255 - i % 9)});
      uvs.push_back({static_cast<float>(i) / 8, -static_cast<float>(i)});
    }
    for (std::uint64_t i = 0; i < mesh.triangles.size(); ++i) values.push_back(~i * 0x9e3779b9);
  }
  BuildInput input() const {
    return BuildInput::Mesh<Vec3>{.vertices = mesh.vertices,
                                  .triangles = mesh.triangles,
                                  .colors = colors,
                                  .uvs = uvs,
                                  .values = values,
                                  .value_kind = ValueKind::kSigned};
  }
};

class Attributes : public InFolder {
 protected:
  static BuildOptions keeping(std::uint32_t attributes) {
    BuildOptions options = small_options();
    options.keep = attributes;
    return options;
  }
  Model opened(const OpenOptions& options = {}) const {
    auto model = Model::open(output(), options);
    EXPECT_TRUE(model) << model.error().text;
    return *std::move(model);
  }
  static void expect_triangle(const Model& model, const Painted& painted, std::uint64_t index) {
    const auto found = model.triangle(index);
    ASSERT_TRUE(found) << found.error().text;
    const std::uint32_t kept = model.info().attributes;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t vertex = painted.mesh.triangles[index][k];
      EXPECT_TRUE(are_equal(found->corners[k], painted.mesh.vertices[vertex])) << index;
      EXPECT_EQ(found->colors[k], (kept & kKeepColor) != 0 ? painted.colors[vertex] : Color());
      EXPECT_EQ(found->uvs[k], (kept & kKeepUv) != 0 ? painted.uvs[vertex] : TextureCoordinate());
    }
    EXPECT_EQ(found->value, (kept & kKeepValue) != 0 ? painted.values[index] : 0);
  }
};

TEST_F(Attributes, AreThoseOfTheMesh) {
  const Painted painted;
  for (std::uint32_t keep = 1; keep <= kAllAttributes; ++keep) {
    const auto report = build(painted.input(), output(), keeping(keep));
    ASSERT_TRUE(report) << report.error().text;
    EXPECT_EQ(report->attributes, keep | kKeepTriangles);
    EXPECT_EQ(report->layers, kAllLayers);
    const Model model = opened();
    EXPECT_EQ(model.info().attributes, keep | kKeepTriangles);
    EXPECT_EQ(model.info().layers, kAllLayers);
    EXPECT_GT(model.info().section_bytes.attribute_pages, 0u);
    EXPECT_EQ(model.info().value_kind,
              (keep & kKeepValue) != 0 ? ValueKind::kSigned : ValueKind::kUnsigned);
    for (std::uint64_t i = 0; i < painted.mesh.triangles.size(); ++i)
      expect_triangle(model, painted, i);
  }
}

TEST_F(Attributes, ChangeNoAnswer) {
  const Painted painted;
  ASSERT_FALSE(built(painted.input()).empty());
  const Model plain = opened();
  ASSERT_TRUE(build(painted.input(), folder_ / "kept.ptree", keeping(kAllAttributes)));
  auto kept = Model::open(folder_ / "kept.ptree");
  ASSERT_TRUE(kept);
  auto of_plain = Probe::create(plain), of_kept = Probe::create(*kept);
  for (int i = 0; i < 200; ++i) {
    const Vec3 query{3 * std::sin(1.7 * i), 3 * std::cos(2.3 * i), std::sin(0.9 * i)};
    const ClosestPoint a = of_plain->closest_point(query), b = of_kept->closest_point(query);
    EXPECT_EQ(a.distance, b.distance);
    EXPECT_EQ(a.side, b.side);
    EXPECT_EQ(a.triangle, b.triangle);
    EXPECT_EQ(a.status, b.status);
  }
}

TEST_F(Attributes, AreInterpolatedAtTheAnswer) {
  const Painted painted;
  ASSERT_FALSE(built(painted.input(), keeping(kAllAttributes)).empty());
  const Model model = opened();
  auto probe = Probe::create(model);
  const Vec3 vertex = painted.mesh.vertices[1234];
  const ClosestPoint at_vertex = probe->closest_point(vertex);
  const auto triangle = model.triangle(at_vertex.triangle);
  ASSERT_TRUE(triangle) << triangle.error().text;
  EXPECT_EQ(triangle->color_at(at_vertex.barycentric), painted.colors[1234]);
  EXPECT_EQ(triangle->uv_at(at_vertex.barycentric), painted.uvs[1234]);
  EXPECT_EQ(triangle->real_value(ValueKind::kSigned),
            static_cast<double>(static_cast<std::int64_t>(painted.values[at_vertex.triangle])));
  MeshTriangle halves;
  halves.colors = {{{0, 10, 255, 0}, {255, 20, 255, 255}, {0, 0, 0, 0}}};
  halves.uvs = {{{0, 1}, {1, 3}, {100, 100}}};
  EXPECT_EQ(halves.color_at({0.5, 0.5, 0}), (Color{128, 15, 255, 128}));
  EXPECT_EQ(halves.uv_at({0.5, 0.5, 0}), (TextureCoordinate{0.5, 2}));
  halves.value = std::bit_cast<std::uint64_t>(-2.5);
  EXPECT_EQ(halves.real_value(ValueKind::kReal), -2.5);
}

// In the order of the mesh, many bytes of little memory are read again and again.
TEST_F(Attributes, FitInLittleMemory) {
  const Painted painted;
  ASSERT_FALSE(built(painted.input(), keeping(kAllAttributes)).empty());
  OpenOptions options;
  options.memory_budget_bytes = 1;
  const auto refused = Model::open(output(), options);
  ASSERT_FALSE(refused);
  options.memory_budget_bytes = std::uint64_t{5} << 20;
  const Model model = opened(options);
  std::vector<std::uint64_t> indices(painted.mesh.triangles.size());
  std::iota(indices.begin(), indices.end(), std::uint64_t{0});
  std::vector<MeshTriangle> triangles(indices.size());
  const auto found = model.triangles(indices, triangles);
  ASSERT_TRUE(found) << found.error().text;
  for (std::size_t i = 0; i < indices.size(); ++i) EXPECT_EQ(triangles[i].value, painted.values[i]);
}

TEST_F(Attributes, AreTheSameBytesForAnyMemoryThreadsAndCheckpoint) {
  const Painted painted;
  BuildOptions options = keeping(kAllAttributes);
  options.threads = 1;
  const std::string bytes = built(painted.input(), options);
  options.threads = 3;
  EXPECT_EQ(built(painted.input(), options), bytes);
  options.memory_bytes = BuildOptions::kMinMemoryBytes;
  EXPECT_EQ(built(painted.input(), options), bytes);
  options.resume = true;
  EXPECT_EQ(built(painted.input(), options), bytes);
}

TEST_F(Attributes, AreResumedWithTheirBuild) {
  Painted painted;
  BuildOptions options = keeping(kAllAttributes);
  const std::string bytes = built(painted.input(), options);
  std::string line;
  options.resume = true;
  options.on_resume = [&line](const std::string& told) { line = told; };
  const auto stop = [&] {
    BuildOptions stopped = options;
    stopped.on_progress = [](BuildPhase phase, std::uint64_t, std::uint64_t) {
      return phase != BuildPhase::kBuildingMask;
    };
    const auto report = build(painted.input(), output(), stopped);
    ASSERT_FALSE(report);
    EXPECT_EQ(report.error().code, ErrorCode::kCancelled);
  };
  stop();
  EXPECT_EQ(built(painted.input(), options), bytes);
  EXPECT_NE(line.find("resum"), std::string::npos) << line;
  stop();
  painted.values[17] ^= 1;
  EXPECT_NE(built(painted.input(), options), bytes);
  EXPECT_NE(line.find("the input has changed"), std::string::npos) << line;
}

TEST_F(Attributes, SkipRecordsThatAreSkipped) {
  Painted painted;
  constexpr std::uint64_t kBad = 777;
  painted.mesh.triangles[kBad][1] = 1'000'000;
  ASSERT_FALSE(built(painted.input(), keeping(kAllAttributes)).empty());
  const Model model = opened();
  const auto bad = model.triangle(kBad);
  ASSERT_FALSE(bad);
  EXPECT_EQ(bad.error().code, ErrorCode::kNotFound);
  expect_triangle(model, painted, kBad - 1);
  expect_triangle(model, painted, kBad + 1);
  expect_triangle(model, painted, painted.mesh.triangles.size() - 1);
}

TEST_F(Attributes, OfARegionAreThoseOfItsTriangles) {
  const Painted painted;
  BuildOptions options = keeping(kKeepValue);
  options.box = Box{{0, 0, -1}, {3, 3, 1}};
  ASSERT_FALSE(built(painted.input(), options).empty());
  const Model model = opened();
  std::uint64_t found = 0;
  for (std::uint64_t i = 0; i < painted.mesh.triangles.size(); ++i) {
    const auto triangle = model.triangle(i);
    if (!triangle) {
      EXPECT_EQ(triangle.error().code, ErrorCode::kNotFound);
      continue;
    }
    ++found;
    EXPECT_EQ(triangle->value, painted.values[i]);
  }
  EXPECT_EQ(found, model.info().triangles);
}

TEST_F(Attributes, NeedTheLayer) {
  const Painted painted;
  ASSERT_FALSE(built(painted.input()).empty());
  const auto without = opened().triangle(0);
  ASSERT_FALSE(without);
  EXPECT_EQ(without.error().code, ErrorCode::kUnsupported);
  EXPECT_NE(std::string(without.error().text).find("--keep"), std::string::npos);
  ASSERT_FALSE(built(painted.input(), keeping(kKeepTriangles)).empty());
  for (const std::uint32_t layers : {0U, kSideLayer, kFieldLayer, kSideLayer | kFieldLayer}) {
    const auto closed = opened({.layers = layers}).triangle(0);
    ASSERT_FALSE(closed);
    EXPECT_EQ(closed.error().code, ErrorCode::kUnsupported);
    const Model open = opened({.read_ahead = true, .layers = layers | kAttributeLayer});
    expect_triangle(open, painted, 17);
    auto probe = Probe::create(open);
    EXPECT_EQ(probe->closest_point({1, 2, 3}, {.parts = kDistance}).status, Status::kExact);
  }
}

TEST_F(Attributes, RefuseWhatIsOutOfRange) {
  const Painted painted;
  ASSERT_FALSE(built(painted.input(), keeping(kKeepTriangles)).empty());
  const Model model = opened();
  for (const std::uint64_t index : {std::uint64_t{painted.mesh.triangles.size()}, kNoTriangle}) {
    const auto found = model.triangle(index);
    ASSERT_FALSE(found);
    EXPECT_EQ(found.error().code, ErrorCode::kBadArgument);
  }
  const std::vector<std::uint64_t> indices = {1, 2, 3};
  std::vector<MeshTriangle> triangles(2);
  const auto found = model.triangles(indices, triangles);
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().code, ErrorCode::kBadArgument);
  EXPECT_TRUE(model.triangles({}, {}));
  const auto report = build(painted.input(), output(), keeping(kAllAttributes + 1));
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().code, ErrorCode::kBadArgument);
}

}  // namespace
}  // namespace planetree::public_api
