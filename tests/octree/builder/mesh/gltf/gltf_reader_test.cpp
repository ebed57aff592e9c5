// Scenes in every layout give the triangles of the same mesh as a PLY.

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>

#include "tests/octree/builder/mesh/gltf/gltf_writer.h"

namespace planetree::octree {
namespace {

using Corners = std::vector<std::uint32_t>;

const std::vector<Position> kPositions = {{0, 0, 0},         {1.5F, 0, 0.25F}, {0.1F, 1, -0.5F},
                                          {1, 1.75F, -0.0F}, {2, 0.5F, 3},     {-1, 0.3F, 2}};
const Corners kCorners = {0, 1, 2, 2, 1, 3, 3, 1, 4, 5, 0, 2};

std::vector<std::array<double, 3>> doubles(const std::vector<Position>& positions) {
  std::vector<std::array<double, 3>> made;
  for (const auto& [x, y, z] : positions)
    made.push_back({static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)});
  return made;
}

std::vector<std::array<std::uint32_t, 3>> triangles_of(const Corners& corners) {
  std::vector<std::array<std::uint32_t, 3>> made;
  for (std::size_t i = 0; i + 2 < corners.size(); i += 3)
    made.push_back({corners[i], corners[i + 1], corners[i + 2]});
  return made;
}

std::string expected_log() { return ply_log(doubles(kPositions), triangles_of(kCorners)); }

/// Reads a scene in each form, with much memory and with little, and expects the same of all.
Reading read_every_form(const GltfWriter& scene) {
  const Reading reading = read_bytes(scene.glb(), ".glb");
  EXPECT_EQ(reading.error, "");
  for (const std::string& bytes : {scene.glb(), scene.embedded(), scene.embedded("\\/")})
    for (const std::uint64_t memory : {std::uint64_t{1} << 20, std::uint64_t{256}}) {
      const Reading other = read_bytes(bytes, ".gltf", memory);
      EXPECT_EQ(other.error, "");
      EXPECT_EQ(other.log, reading.log);
      EXPECT_EQ(notes_of(other), notes_of(reading));
    }
  const TemporaryFile data(scene.buffer.str(), " of it.bin");
  const std::string name = data.path().filename().string();
  std::string uri = name;
  uri.replace(uri.find(' '), 1, "%20");
  for (const std::string& named : {name, uri}) {
    const Reading beside = read_bytes(scene.beside(named), ".gltf");
    EXPECT_EQ(beside.error, "");
    EXPECT_EQ(beside.log, reading.log);
  }
  return reading;
}

TEST(GltfReader, ReadsEveryTypeOfIndex) {
  for (const Component type : {Component::kUint8, Component::kUint16, Component::kUint32}) {
    GltfWriter scene;
    const std::size_t positions = scene.positions(kPositions);
    scene.mesh({scene.primitive(positions, scene.indices(kCorners, type))});
    const Reading reading = read_every_form(scene);
    EXPECT_EQ(reading.log, expected_log());
    ASSERT_TRUE(reading.summary);
    EXPECT_EQ(reading.summary->vertex_records, kPositions.size());
    EXPECT_EQ(reading.summary->face_records, 4U);
    EXPECT_TRUE(reading.summary->float32);
    EXPECT_EQ(notes_of(reading), "");
  }
}

TEST(GltfReader, ReadsPrimitivesWithoutIndices) {
  std::vector<Position> listed;
  for (const std::uint32_t corner : kCorners) listed.push_back(kPositions[corner]);
  GltfWriter scene;
  scene.mesh({scene.primitive(scene.positions(listed))});
  EXPECT_EQ(read_every_form(scene).log, expected_log());
}

TEST(GltfReader, ReadsStripsAndFans) {
  const Corners corners = {0, 1, 2, 3, 4, 5};
  const std::vector<std::array<std::uint32_t, 3>> strip = {
      {0, 1, 2}, {1, 3, 2}, {2, 3, 4}, {3, 5, 4}};
  const std::vector<std::array<std::uint32_t, 3>> fan = {
      {1, 2, 0}, {2, 3, 0}, {3, 4, 0}, {4, 5, 0}};
  for (const int mode : {5, 6})
    for (const bool has_indices : {false, true}) {
      GltfWriter scene;
      nlohmann::json primitive = scene.primitive(scene.positions(kPositions));
      if (has_indices) primitive["indices"] = scene.indices(corners, Component::kUint8);
      primitive["mode"] = mode;
      scene.mesh({primitive});
      EXPECT_EQ(read_every_form(scene).log, ply_log(doubles(kPositions), mode == 5 ? strip : fan));
    }
}

// A strip that is joined with the next by repeated vertices, as programs do.
TEST(GltfReader, LeavesOutTrianglesOfStripsThatOnlyLeadOn) {
  GltfWriter scene;
  nlohmann::json primitive = scene.primitive(
      scene.positions(kPositions), scene.indices({0, 1, 2, 2, 3, 3, 4, 5}, Component::kUint16));
  primitive["mode"] = 5;
  scene.mesh({primitive});
  const Reading reading = read_every_form(scene);
  EXPECT_EQ(reading.log, ply_log(doubles(kPositions), {{0, 1, 2}, {3, 5, 4}}));
  EXPECT_EQ(notes_of(reading), "4 triangles of strips and fans with two equal vertices left out\n");
  EXPECT_EQ(reading.summary->triangle_indices, 2U);
}

TEST(GltfReader, ReadsInterleavedPositions) {
  GltfWriter scene;
  Bytes records;
  records.put(1.0F, 2.0F);
  for (const auto& [x, y, z] : kPositions) records.put(x, y, z, 7.0F, 8.0F, std::uint32_t{9});
  const std::size_t view = scene.view(records, 24);
  scene.mesh({scene.primitive(scene.accessor(view, Component::kFloat, kPositions.size(), "VEC3", 8),
                              scene.indices(kCorners, Component::kUint32))});
  EXPECT_EQ(read_every_form(scene).log, expected_log());
}

// The last three vertices are in place of others, or of zeros.
TEST(GltfReader, ReadsSparsePositions) {
  for (const bool has_base : {false, true})
    for (const Component type : {Component::kUint8, Component::kUint16, Component::kUint32}) {
      GltfWriter scene;
      std::vector<Position> base = kPositions;
      base[0] = {0, 0, 0};
      for (std::size_t i = 1; i < base.size(); ++i)
        if (!has_base || i >= 3) base[i] = {-9, -9, -9};
      Corners replaced;
      std::vector<Position> values;
      for (std::uint32_t i = has_base ? 3 : 1; i < kPositions.size(); ++i) {
        replaced.push_back(i);
        values.push_back(kPositions[i]);
      }
      const std::size_t positions = scene.positions(base);
      nlohmann::json& accessor = scene.document["accessors"][positions];
      if (!has_base) accessor.erase("bufferView");
      accessor["sparse"] = {{"count", replaced.size()},
                            {"indices",
                             {{"bufferView", scene.view(GltfWriter::bytes_of(replaced, type))},
                              {"componentType", static_cast<int>(type)}}},
                            {"values", {{"bufferView", scene.view(GltfWriter::bytes_of(values))}}}};
      scene.mesh({scene.primitive(positions, scene.indices(kCorners, Component::kUint8))});
      EXPECT_EQ(read_every_form(scene).log, expected_log());
    }
}

TEST(GltfReader, ReadsSparseIndices) {
  GltfWriter scene;
  const std::size_t positions = scene.positions(kPositions);
  Corners base = kCorners;
  base[4] = base[9] = 0;
  const std::size_t indices = scene.indices(base, Component::kUint16);
  scene.document["accessors"][indices]["sparse"] = {
      {"count", 2},
      {"indices",
       {{"bufferView", scene.view(GltfWriter::bytes_of({4, 9}, Component::kUint8))},
        {"componentType", 5121}}},
      {"values",
       {{"bufferView",
         scene.view(GltfWriter::bytes_of({kCorners[4], kCorners[9]}, Component::kUint16))}}}};
  scene.mesh({scene.primitive(positions, indices)});
  EXPECT_EQ(read_every_form(scene).log, expected_log());
}

// KHR_mesh_quantization. Fractions are those of the largest integer, -1 at least.
TEST(GltfReader, ReadsQuantizedPositions) {
  GltfWriter scene;
  scene.document["extensionsRequired"] = {"KHR_mesh_quantization"};
  Bytes records;
  for (const std::array<int, 3>& p :
       {std::array{0, 32767, -32768}, std::array{100, -200, 300}, std::array{7, 8, 9}})
    records.put(static_cast<std::int16_t>(p[0]), static_cast<std::int16_t>(p[1]),
                static_cast<std::int16_t>(p[2]), std::int16_t{0});
  const std::size_t view = scene.view(records, 8);
  const std::size_t plain = scene.accessor(view, Component::kInt16, 3);
  const std::size_t fractions = scene.accessor(view, Component::kInt16, 3);
  scene.document["accessors"][fractions]["normalized"] = true;
  scene.mesh({scene.primitive(plain), scene.primitive(fractions)});
  const Reading reading = read_every_form(scene);
  EXPECT_EQ(reading.log, ply_log({{0, 32767, -32768},
                                  {100, -200, 300},
                                  {7, 8, 9},
                                  {0, 1, -1},
                                  {100 / 32767.0, -200 / 32767.0, 300 / 32767.0},
                                  {7 / 32767.0, 8 / 32767.0, 9 / 32767.0}},
                                 {{0, 1, 2}, {3, 4, 5}}));
  EXPECT_FALSE(reading.summary->float32);
}

// Skips faces and keeps the numbers of those behind them, over several primitives.
TEST(GltfReader, SkipsFacesWithBadVertices) {
  GltfWriter scene;
  std::vector<Position> positions = kPositions;
  positions[5] = {NAN, 0, 0};
  const std::size_t bad = scene.positions(positions);
  const nlohmann::json primitive = scene.primitive(
      bad, scene.indices({0, 1, 2, 0, 1, 5, 0, 255, 2, 2, 1, 0}, Component::kUint8));
  scene.mesh({primitive, primitive});
  const Reading reading = read_every_form(scene);
  EXPECT_NE(reading.log.find("1+1 aside: face 1: vertex 5 is not finite\n"), std::string::npos);
  EXPECT_NE(reading.log.find("6+1 aside: face 6: vertex index 255 is out of range, the mesh has 6 "
                             "vertices\n"),
            std::string::npos)
      << reading.log;
  EXPECT_EQ(reading.summary->triangle_indices, 8U);
}

TEST(GltfReader, TellsWhatItPassesOver) {
  GltfWriter scene;
  const std::size_t positions = scene.positions(kPositions);
  nlohmann::json lines = scene.primitive(positions), morphed = scene.primitive(positions);
  lines["mode"] = 1;
  morphed["targets"] = {{{"POSITION", positions}}};
  const nlohmann::json bare = {{"attributes", nlohmann::json::object()}};
  nlohmann::json long_one =
      scene.primitive(positions, scene.indices({0, 1, 2, 3}, Component::kUint8));
  const std::size_t shown = scene.mesh({lines, morphed, bare, long_one});
  scene.mesh({lines});
  const std::size_t skinned =
      scene.node({{"mesh", shown}, {"skin", 0}, {"translation", {5, 5, 5}}});
  scene.node({{"mesh", shown}});
  scene.add("scenes", {{"nodes", {skinned}}});
  scene.add("scenes", {{"nodes", {1}}});
  const Reading reading = read_bytes(scene.glb() + "more", ".glb");
  EXPECT_EQ(reading.error, "");
  EXPECT_EQ(reading.log, ply_log(doubles(kPositions), {{0, 1, 2}, {3, 4, 5}, {0, 1, 2}}));
  EXPECT_EQ(notes_of(reading),
            "1 mesh of no node of the scene not read\n"
            "1 mesh with a skin read as stored, in no pose of its joints\n"
            "4 bytes behind the end of the GLB not read\n"
            "1 other scene not read\n"
            "1 primitive of points or lines not read\n"
            "1 primitive without positions not read\n"
            "1 primitive with morph targets read without them\n"
            "1 corner behind the last triangle of a primitive not read\n");
}

// The text of a document is small, whatever strings and numbers it has beside those that are read.
TEST(GltfReader, PassesOverEverythingElse) {
  GltfWriter scene;
  const std::size_t positions = scene.positions(kPositions);
  nlohmann::json primitive = scene.primitive(positions, scene.indices(kCorners, Component::kUint8));
  primitive["attributes"]["NORMAL"] = positions;
  primitive["extras"] = {{"primitives", {1, 2, 3}}, {"nodes", nlohmann::json::array({nullptr})}};
  scene.mesh({primitive});
  scene.document["extras"] = {{"buffers", 7}};
  scene.document["images"] = {{{"uri", "data:image/png;base64," + std::string(100000, 'A')}}};
  scene.document["materials"] = {
      {{"name", std::string(10000, 'x') + "\\u00e9 \xC3\xA9 \" \\"}, {"doubleSided", true}}};
  scene.document["extensionsUsed"] = {"KHR_materials_unlit", "ANY_other"};
  scene.document["extensionsRequired"] = {"KHR_materials_unlit"};
  EXPECT_EQ(read_every_form(scene).log, expected_log());
}

}  // namespace
}  // namespace planetree::octree
