// Files that are truncated, have wrong counts or hold bad records, in every format.

#include <gtest/gtest.h>

#include <fstream>
#include <limits>
#include <utility>

#include "octree/builder/tree_builder.h"
#include "tests/octree/builder/mesh/mesh_formats.h"
#include "tests/octree/builder/silent_progress.h"
#include "tests/storage/system/temporary_directory.h"

namespace planetree::octree {
namespace {

std::string name_of(const testing::TestParamInfo<MeshFormat>& info) { return info.param.name; }

/// A mesh whose coordinates do not look like counts, and whose faces are invalid when read with a
/// vertex count that is too large by one. The last face is a quadrangle in formats with polygons.
PlainMesh small_mesh(const MeshFormat& format) {
  PlainMesh mesh{{{0.5F, 0.25F, 0}, {1.5F, 0, 0.5F}, {0.5F, 1.5F, 0}, {0.25F, 0.5F, 2.5F}}, {}};
  mesh.faces = {{0, 1, 3}, {0, 1, 2}, {3, 0, 1}};
  if (format.has_polygons) mesh.faces.back().push_back(2);
  return mesh;
}

Reading read_as(const MeshFormat& format, const PlainMesh& mesh) {
  return read_bytes(format.write(mesh, {}), format.extension);
}

/// Builds from `bytes`. A refused build must leave no file behind.
Result<BuildReport> build_bytes(const MeshFormat& format, std::string_view bytes) {
  const storage::TemporaryDirectory folder;
  const std::string mesh = std::string("mesh") + format.extension;
  std::ofstream(folder / mesh.c_str(), std::ios::binary) << bytes;
  BuildOptions options;
  options.threads = 1;
  SilentProgress progress;
  auto report = build_tree(folder / mesh.c_str(), folder / "mesh.ptree", options, progress);
  if (!report) {
    EXPECT_EQ(folder.names(), std::vector<std::string>{mesh});
  }
  return report;
}

void expect_refused(const MeshFormat& format, std::string_view bytes, const std::string& how) {
  const auto report = build_bytes(format, bytes);
  ASSERT_FALSE(report) << how;
  EXPECT_EQ(report.error().code, ErrorCode::kBadInput) << how << ": " << report.error().text;
}

/// Expects each line of `log` to begin and end with the given texts.
void expect_lines(const Reading& reading,
                  const std::vector<std::pair<std::string_view, std::string_view>>& lines) {
  EXPECT_EQ(reading.error, "");
  std::string_view rest = reading.log;
  for (const auto& [begin, end] : lines) {
    const std::string_view line = rest.substr(0, rest.find('\n'));
    EXPECT_TRUE(line.starts_with(begin) && line.ends_with(end)) << line;
    rest.remove_prefix(std::min(line.size() + 1, rest.size()));
  }
  EXPECT_EQ(rest, "");
}

// All formats but OBJ, whose truncated files may be valid.
class MeshWithAnEnd : public testing::TestWithParam<MeshFormat> {};
INSTANTIATE_TEST_SUITE_P(All, MeshWithAnEnd,
                         testing::ValuesIn(formats_that([](const MeshFormat& format) {
                           return format.has_end;
                         })),
                         name_of);

// Sanitizers are slow here, so with them only some lengths are tested.
#ifdef NDEBUG
constexpr std::size_t kCutStep = 1;
#else
constexpr std::size_t kCutStep = 11;
#endif

TEST_P(MeshWithAnEnd, IsRefusedAtEveryTruncation) {
  const std::string whole = GetParam().write(small_mesh(GetParam()), {});
  const auto report = build_bytes(GetParam(), whole);
  ASSERT_TRUE(report) << report.error().text;
  // The last newline of a text may be missing.
  const std::size_t least = whole.size() - (GetParam().is_text ? 1 : 0);
  EXPECT_TRUE(build_bytes(GetParam(), whole.substr(0, least)));
  for (std::size_t size = 0; size < least; size += kCutStep) {
    // Without 'endsolid' an STL may be whole.
    const std::string cut = whole.substr(0, size);
    if (cut.ends_with("endfacet") || cut.ends_with("endfacet\n")) continue;
    expect_refused(GetParam(), cut, std::to_string(size) + " bytes");
  }
}

TEST(MeshWithoutAnEnd, DeliversWhatATruncatedFileHolds) {
  const MeshFormat obj =
      formats_that([](const MeshFormat& format) { return format.name == std::string("Obj"); })[0];
  const std::string whole = obj.write(small_mesh(obj), {});
  const std::string log = read_bytes(whole, obj.extension).log;
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const Reading reading = read_bytes(whole.substr(0, size), obj.extension);
    if (!reading.summary) {
      EXPECT_EQ(reading.code, ErrorCode::kBadInput) << size;
      continue;
    }
    // The last face may have lost corners.
    const std::string sound = reading.log.substr(0, reading.log.find(" aside") - 3);
    EXPECT_EQ(log.substr(0, sound.size()), sound) << size;
  }
}

class MeshWithCounts : public testing::TestWithParam<MeshFormat> {};
INSTANTIATE_TEST_SUITE_P(All, MeshWithCounts,
                         testing::ValuesIn(formats_that([](const MeshFormat& format) {
                           return format.has_counts;
                         })),
                         name_of);

TEST_P(MeshWithCounts, IsRefusedWhenCountsAreWrong) {
  constexpr std::int64_t kMany = std::numeric_limits<std::int32_t>::max() - 10;
  std::vector<CountError> lies{{0, 1}, {0, -1}, {0, -3}, {0, kMany}};
  if (GetParam().is_indexed)
    lies.insert(lies.end(),
                {{1, 0}, {-1, 0}, {-4, 0}, {kMany, 0}, {1, -1}, {-1, 1}, {kMany, kMany}});
  for (const CountError& lie : lies)
    expect_refused(GetParam(), GetParam().write(small_mesh(GetParam()), lie),
                   std::to_string(lie.vertices) + " vertices and " + std::to_string(lie.faces) +
                       " faces more");
}

class MeshWithIndices : public testing::TestWithParam<MeshFormat> {};
INSTANTIATE_TEST_SUITE_P(All, MeshWithIndices,
                         testing::ValuesIn(formats_that([](const MeshFormat& format) {
                           return format.is_indexed && format.has_polygons;
                         })),
                         name_of);

TEST_P(MeshWithIndices, SkipsFacesWithIndicesOutOfRange) {
  std::vector<std::int64_t> indices{-1,         4,           2147483647,
                                    2147483648, 4294967295U, -2147483647 - std::int64_t{1}};
  if (GetParam().is_text) indices.push_back(std::int64_t{1} << 62);
  for (const std::int64_t index : indices) {
    PlainMesh mesh = small_mesh(GetParam());
    mesh.faces = {{0, 1, 2}, {0, 1, index, 2}, {2, 1, 0}};
    expect_lines(
        read_as(GetParam(), mesh),
        {{"0: ", ""}, {"1+2 aside: ", " is out of range, the mesh has 4 vertices"}, {"3: ", ""}});
  }
}

class MeshWithPolygons : public testing::TestWithParam<MeshFormat> {};
INSTANTIATE_TEST_SUITE_P(All, MeshWithPolygons,
                         testing::ValuesIn(formats_that([](const MeshFormat& format) {
                           return format.has_polygons;
                         })),
                         name_of);

TEST_P(MeshWithPolygons, SkipsFacesWithFewerThanThreeCorners) {
  PlainMesh mesh = small_mesh(GetParam());
  mesh.faces = {{}, {0, 1, 2}, {3}, {0, 3}, {2, 1, 0}};
  expect_lines(read_as(GetParam(), mesh), {{"0+1 aside: ", " has 0 corners, fewer than 3"},
                                           {"1: ", ""},
                                           {"2+1 aside: ", " has 1 corners, fewer than 3"},
                                           {"3+1 aside: ", " has 2 corners, fewer than 3"},
                                           {"4: ", ""}});
}

/// Counts the calls to a sink.
class Tally final : public TriangleSink {
 public:
  Result<void> triangle(std::uint64_t, const std::array<Vec3, 3>&) override {
    ++triangles;
    return {};
  }
  void skipped(std::uint64_t, std::uint64_t count, const SkippedRecord&) override {
    ++records_skipped;
    indices_skipped += count;
  }
  Result<void> progress(std::uint64_t, std::uint64_t) override { return {}; }

  std::uint64_t triangles = 0, records_skipped = 0, indices_skipped = 0;
};

TEST_P(MeshWithPolygons, SplitsOrSkipsAFaceOfAMillionCorners) {
  constexpr std::uint64_t kCorners = 1000000;
  PlainMesh mesh = small_mesh(GetParam());
  mesh.vertices.push_back({std::numeric_limits<float>::quiet_NaN(), 0, 0});
  std::vector<std::int64_t> many;
  for (std::uint64_t k = 0; k < kCorners; ++k) many.push_back(static_cast<std::int64_t>(k % 4));
  mesh.faces = {{0, 1, 2}, many, {2, 1, 0}};
  for (const bool sound : {true, false}) {
    if (!sound) mesh.faces[1].back() = 4;
    const TemporaryFile file(GetParam().write(mesh, {}), GetParam().extension);
    Tally tally;
    const auto summary = read_mesh(file.path(), tally);
    ASSERT_TRUE(summary) << summary.error().text;
    EXPECT_EQ(summary->triangle_indices, kCorners);
    EXPECT_EQ(tally.triangles, sound ? kCorners : 2);
    EXPECT_EQ(tally.records_skipped, sound ? 0U : 1U);
    EXPECT_EQ(tally.indices_skipped, sound ? 0 : kCorners - 2);
  }
}

class MeshOfEveryFormat : public testing::TestWithParam<MeshFormat> {};
INSTANTIATE_TEST_SUITE_P(All, MeshOfEveryFormat,
                         testing::ValuesIn(formats_that([](const MeshFormat&) { return true; })),
                         name_of);

TEST_P(MeshOfEveryFormat, SkipsFacesWithNonFiniteVertices) {
  const float infinity = std::numeric_limits<float>::infinity();
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), infinity, -infinity}) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      PlainMesh mesh = small_mesh(GetParam());
      mesh.vertices[3][axis] = bad;
      mesh.faces = {{0, 1, 3}, {0, 1, 2}, {3, 2, 1}, {2, 1, 0}};
      expect_lines(read_as(GetParam(), mesh), {{"0+1 aside: ", " is not finite"},
                                               {"1: ", ""},
                                               {"2+1 aside: ", " is not finite"},
                                               {"3: ", ""}});
    }
  }
}

TEST_P(MeshOfEveryFormat, IsRefusedWithoutAValidFace) {
  PlainMesh mesh = small_mesh(GetParam());
  mesh.faces = {};
  expect_refused(GetParam(), GetParam().write(mesh, {}), "no face");
  mesh.faces = {{0, 1, 3}};
  mesh.vertices[0][0] = std::numeric_limits<float>::infinity();
  expect_refused(GetParam(), GetParam().write(mesh, {}), "no sound face");
}

}  // namespace
}  // namespace planetree::octree
