// Colours and texture coordinates of glTF files.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "tests/octree/builder/mesh/gltf/gltf_writer.h"

namespace planetree::octree {
namespace {

const std::vector<Position> kPositions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};

/// A primitive of a triangle with attributes.
nlohmann::json triangle(GltfWriter& scene, const nlohmann::json& attributes) {
  nlohmann::json made = GltfWriter::primitive(scene.positions(kPositions));
  for (const auto& [name, accessor] : attributes.items()) made["attributes"][name] = accessor;
  return made;
}

std::size_t normalized(GltfWriter& scene, std::size_t accessor) {
  scene.document["accessors"][accessor]["normalized"] = true;
  return accessor;
}

/// Reads with much memory and with little, and expects the same.
Reading read_both(const GltfWriter& scene, std::uint32_t keep) {
  return read_kept_twice(scene.glb(), ".glb", keep, 256);
}

/// The line of attributes of a mesh of one triangle.
std::string attributes_of(const GltfWriter& scene, std::uint32_t keep) {
  const Reading reading = read_both(scene, keep);
  EXPECT_EQ(reading.error, "");
  return reading.log.substr(std::min(reading.log.size(), reading.log.find('\n') + 1));
}

TEST(GltfAttributes, ColoursHaveSeveralTypes) {
  GltfWriter floats, bytes, shorts;
  Bytes of_floats, of_bytes, of_shorts;
  of_floats.put(0.0F, 0.5F, 1.0F, 1.0F, 1.0F, 1.0F, 2.0F, -1.0F, 0.2F);
  for (const int channel : {0, 128, 255, 7, 255, 255, 255, 8, 255, 0, 51, 9})
    of_bytes.put(static_cast<std::uint8_t>(channel));
  for (const int channel : {0, 32896, 65535, 65535, 65535, 65535, 65535, 0, 13107, 0})
    of_shorts.put(static_cast<std::uint16_t>(channel));
  floats.mesh({triangle(
      floats, {{"COLOR_0", floats.accessor(floats.view(of_floats), Component::kFloat, 3)}})});
  bytes.mesh({triangle(
      bytes, {{"COLOR_0", normalized(bytes, bytes.accessor(bytes.view(of_bytes), Component::kUint8,
                                                           3, "VEC4"))}})});
  // Elements of six bytes every eight.
  shorts.mesh({triangle(
      shorts,
      {{"COLOR_0",
        normalized(shorts,
                   shorts.accessor(shorts.view(Bytes()
                                                   .put(std::uint16_t{0}, std::uint16_t{32896},
                                                        std::uint16_t{65535}, std::uint16_t{1})
                                                   .put(std::uint16_t{65535}, std::uint16_t{65535},
                                                        std::uint16_t{65535}, std::uint16_t{1})
                                                   .put(std::uint16_t{65535}, std::uint16_t{0},
                                                        std::uint16_t{13107}, std::uint16_t{1}),
                                               8),
                                   Component::kUint16, 3))}})});
  EXPECT_EQ(attributes_of(floats, kKeepColor),
            "  #0080ffff 0 0, #ffffffff 0 0, #ff0033ff 0 0, value 0\n");
  EXPECT_EQ(attributes_of(bytes, kKeepColor),
            "  #0080ff07 0 0, #ffffff08 0 0, #ff003309 0 0, value 0\n");
  EXPECT_EQ(attributes_of(shorts, kKeepColor), attributes_of(floats, kKeepColor));
}

TEST(GltfAttributes, MayBeInterleavedWithPositions) {
  GltfWriter scene;
  Bytes bytes;
  for (std::size_t i = 0; i < kPositions.size(); ++i) {
    const auto& [x, y, z] = kPositions[i];
    const auto number = static_cast<std::uint8_t>(i);
    bytes.put(x, y, z).put(number, std::uint8_t{2}, std::uint8_t{3}, std::uint8_t{4});
    bytes.put(static_cast<float>(i), 0.5F);
  }
  const std::size_t view = scene.view(bytes, 24);
  nlohmann::json primitive = GltfWriter::primitive(scene.accessor(view, Component::kFloat, 3));
  primitive["attributes"]["COLOR_0"] =
      normalized(scene, scene.accessor(view, Component::kUint8, 3, "VEC4", 12));
  primitive["attributes"]["TEXCOORD_0"] = scene.accessor(view, Component::kFloat, 3, "VEC2", 16);
  scene.mesh({primitive});
  EXPECT_EQ(attributes_of(scene, kKeepColor | kKeepUv),
            "  #00020304 0 0.5, #01020304 1 0.5, #02020304 2 0.5, value 0\n");
  // A node that mirrors turns the triangle with its attributes.
  scene.node({{"mesh", 0}, {"scale", {1, 1, -1}}});
  EXPECT_EQ(attributes_of(scene, kKeepUv),
            "  #000000ff 0 0.5, #000000ff 2 0.5, #000000ff 1 0.5, value 0\n");
}

TEST(GltfAttributes, MayBeSparse) {
  GltfWriter scene;
  Bytes indices, values;
  indices.put(std::uint8_t{1});
  values.put(0.25F, 0.75F);
  const std::size_t uvs = scene.accessor(
      scene.view(Bytes().put(0.0F, 0.0F, 0.0F, 0.0F, 1.0F, 1.0F)), Component::kFloat, 3, "VEC2");
  scene.document["accessors"][uvs]["sparse"] = {
      {"count", 1},
      {"indices", {{"bufferView", scene.view(indices)}, {"componentType", 5121}}},
      {"values", {{"bufferView", scene.view(values)}}}};
  scene.mesh({triangle(scene, {{"TEXCOORD_0", uvs}})});
  EXPECT_EQ(attributes_of(scene, kKeepUv),
            "  #000000ff 0 0, #000000ff 0.25 0.75, #000000ff 1 1, value 0\n");
}

TEST(GltfAttributes, TextureCoordinatesMayBeIntegers) {
  GltfWriter scene;
  Bytes uvs;
  for (const int number : {0, 255, 51, 0, 255, 255})
    uvs.put(static_cast<std::uint16_t>(257 * number));
  scene.mesh({triangle(
      scene, {{"TEXCOORD_0", normalized(scene, scene.accessor(scene.view(uvs), Component::kUint16,
                                                              3, "VEC2"))}})});
  EXPECT_EQ(attributes_of(scene, kKeepUv),
            "  #000000ff 0 1, #000000ff 0.200000003 0, #000000ff 1 1, value 0\n");
}

TEST(GltfAttributes, ThatAPrimitiveLacksAreWhiteOrZero) {
  GltfWriter scene;
  const std::size_t colors = scene.accessor(
      scene.view(Bytes().put_all(std::vector<float>(9, 0.0F))), Component::kFloat, 3);
  const std::size_t uvs = scene.accessor(scene.view(Bytes().put_all(std::vector<float>(6, 2.0F))),
                                         Component::kFloat, 3, "VEC2");
  scene.mesh({triangle(scene, {{"COLOR_0", colors}}), triangle(scene, {{"TEXCOORD_0", uvs}})});
  const Reading reading = read_both(scene, kKeepColor | kKeepUv);
  EXPECT_EQ(reading.log,
            "0: 0 0 0, 1 0 0, 0 1 0\n  #000000ff 0 0, #000000ff 0 0, #000000ff 0 0, value 0\n"
            "1: 0 0 0, 1 0 0, 0 1 0\n  #ffffffff 2 2, #ffffffff 2 2, #ffffffff 2 2, value 0\n");
  EXPECT_EQ(notes_of(reading),
            "1 primitive without 'COLOR_0' read as white\n"
            "1 primitive without 'TEXCOORD_0' read with zeros\n");
  EXPECT_EQ(notes_of(read_both(scene, 0)), "");
}

TEST(GltfAttributes, ThatAreMissingOrWrongAreRefused) {
  GltfWriter plain;
  plain.mesh({triangle(plain, nlohmann::json::object())});
  EXPECT_EQ(read_both(plain, kKeepColor).error,
            "no colours: no primitive with 'COLOR_0'; build the mesh without --keep color");
  EXPECT_EQ(read_both(plain, kKeepUv).error,
            "no texture coordinates: no primitive with 'TEXCOORD_0'; build the mesh without --keep "
            "uv");
  EXPECT_EQ(read_both(plain, kKeepValue).error,
            "a glTF has no values of triangles that are read; give a PLY for --keep value");
  GltfWriter few;
  few.mesh({triangle(
      few, {{"COLOR_0", few.accessor(few.view(Bytes().put_all(std::vector<float>(6, 0.0F))),
                                     Component::kFloat, 2)}})});
  EXPECT_EQ(read_both(few, kKeepColor).error,
            "accessor 0 has 2 elements for 3 vertices; copy or export the glTF again");
  GltfWriter integers;
  integers.mesh({triangle(
      integers, {{"COLOR_0", integers.accessor(
                                 integers.view(Bytes().put_all(std::vector<std::uint8_t>(12, 1))),
                                 Component::kUint8, 3, "VEC4")}})});
  EXPECT_EQ(read_both(integers, kKeepColor).code, ErrorCode::kBadInput);
}

}  // namespace
}  // namespace planetree::octree
