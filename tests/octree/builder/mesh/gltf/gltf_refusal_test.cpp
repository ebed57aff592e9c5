// What cannot be read is refused, and the message names it.

#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "tests/octree/builder/mesh/gltf/gltf_writer.h"

namespace planetree::octree {
namespace {

using Json = nlohmann::json;

/// A mesh of one triangle with indices: accessor 0 has positions, accessor 1 indices.
GltfWriter small_scene() {
  GltfWriter scene;
  const std::size_t positions = scene.positions({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  scene.mesh({scene.primitive(positions, scene.indices({0, 1, 2}, Component::kUint16))});
  scene.node({{"mesh", 0}});
  return scene;
}

void expect_refused(const std::string& bytes, const std::string& message,
                    const std::string& extension = ".gltf") {
  const Reading reading = read_bytes(bytes, extension);
  EXPECT_FALSE(reading.summary) << message;
  EXPECT_EQ(reading.code, ErrorCode::kBadInput) << reading.error;
  EXPECT_NE(reading.error.find(message), std::string::npos) << "said: " << reading.error;
}

void expect_refused(const std::function<void(Json&)>& change, const std::string& message) {
  GltfWriter scene = small_scene();
  change(scene.document);
  expect_refused(scene.glb(), message);
}

TEST(GltfRefusal, NamesTheVersion) {
  expect_refused([](Json& d) { d["asset"]["version"] = "1.0"; }, "a glTF of version '1.0', not 2");
  expect_refused([](Json& d) { d.erase("asset"); }, "the document has no object 'asset'");
  std::string old = small_scene().glb();
  old[4] = 1;
  expect_refused(old, "byte 4: a GLB of glTF version 1, not 2; export it as glTF 2.0");
}

TEST(GltfRefusal, NamesCompression) {
  expect_refused([](Json& d) { d["extensionsRequired"] = {"KHR_draco_mesh_compression"}; },
                 "compressed by Draco (KHR_draco_mesh_compression); export it without");
  expect_refused([](Json& d) { d["extensionsRequired"] = {"EXT_meshopt_compression"}; },
                 "compressed by meshoptimizer (EXT_meshopt_compression)");
  expect_refused(
      [](Json& d) {
        d["extensionsRequired"] = {"KHR_materials_unlit", "X_tiles"};
      },
      "it requires the extension 'X_tiles', which is not read");
}

// Compressed data that is not required has a plain form beside it, unless that is missing.
TEST(GltfRefusal, ReadsThePlainFormOfCompressedPrimitives) {
  GltfWriter scene = small_scene();
  Json& primitive = scene.document["meshes"][0]["primitives"][0];
  primitive["extensions"] = {{"KHR_draco_mesh_compression", {{"bufferView", 0}}}};
  EXPECT_EQ(read_bytes(scene.glb()).log, read_bytes(small_scene().glb()).log);
  scene.document["accessors"][0].erase("bufferView");
  expect_refused(scene.glb(), "a primitive is compressed by Draco");
  GltfWriter fallback = small_scene();
  Json document = fallback.document;
  document["buffers"] =
      Json::array({Json({{"byteLength", 36}, {"extensions", {{"EXT_meshopt_compression", {}}}}})});
  document["buffers"][0]["extensions"]["EXT_meshopt_compression"] = {{"fallback", true}};
  expect_refused(document.dump(), "buffer 0 is compressed by meshoptimizer");
}

TEST(GltfRefusal, NamesWhatIsNoNumber) {
  for (const Json& bad : {Json(-1), Json(1.5), Json("3"), Json(nullptr), Json(1e300)})
    expect_refused([&](Json& d) { d["accessors"][0]["count"] = bad; },
                   "accessor 0 'count' is not an integer from 0");
  expect_refused([](Json& d) { d["bufferViews"][0].erase("buffer"); },
                 "bufferView 0 has no 'buffer'");
  expect_refused([](Json& d) { d["accessors"][1]["componentType"] = 5124; },
                 "accessor 1 has an unknown 'componentType'");
  expect_refused(
      [](Json& d) {
        d["nodes"][0]["matrix"] = {1, 2, 3};
      },
      "node 0 'matrix' is not a list of 16 numbers");
  expect_refused(
      [](Json& d) {
        d["nodes"][0]["scale"] = {1, 2, "x"};
      },
      "node 0 'scale' is not a list of 3 numbers");
  expect_refused(
      [](Json& d) {
        d["nodes"][0]["rotation"] = {0, 0, 0, 0};
      },
      "node 0 has a transform that is not finite");
  expect_refused(
      [](Json& d) { d["nodes"][0]["matrix"] = {1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}; },
      "node 0 has a 'matrix' that is not affine");
  expect_refused([](Json& d) { d["nodes"] = 3; }, "'nodes' is not a list");
  expect_refused([](Json& d) { d["nodes"] = Json::object(); }, "'nodes' is not a list");
  expect_refused([](Json& d) { d["nodes"] = {3}; }, "node 0, or a part of it, is not an object");
  expect_refused([](Json& d) { d["meshes"][0]["primitives"] = Json::array({3}); },
                 "mesh 0, or a part of it, is not an object");
  expect_refused([](Json& d) { d["meshes"][0].erase("primitives"); },
                 "mesh 0 has no list of 'primitives'");
  expect_refused([](Json& d) { d["meshes"][0]["primitives"][0]["mode"] = 9; },
                 "a primitive of an unknown 'mode'");
}

TEST(GltfRefusal, NamesWhatDoesNotExist) {
  expect_refused(
      [](Json& d) {
        d["scene"] = 0;
        d["scenes"] = Json::array({Json{{"nodes", {7}}}});
      },
      "node 7 does not exist");
  expect_refused(
      [](Json& d) {
        d["scene"] = 1;
        d["scenes"] = {{{"nodes", {0}}}};
      },
      "scene 1 does not exist");
  expect_refused([](Json& d) { d["nodes"][0]["mesh"] = 1; },
                 "node 0 has a mesh that does not exist");
  expect_refused([](Json& d) { d["accessors"].erase(1); }, "accessor 1 does not exist");
  expect_refused([](Json& d) { d["accessors"][0]["bufferView"] = 2; },
                 "accessor 0 names a bufferView that does not exist");
  expect_refused([](Json& d) { d["bufferViews"][0]["buffer"] = 1; }, "buffer 1 does not exist");
}

TEST(GltfRefusal, NamesWhatExceedsItsPlace) {
  expect_refused([](Json& d) { d["accessors"][0]["count"] = 4; },
                 "accessor 0 has 4 elements, its bufferView 3");
  expect_refused([](Json& d) { d["accessors"][0]["byteOffset"] = 4; },
                 "accessor 0 has 3 elements, its bufferView 2");
  expect_refused([](Json& d) { d["accessors"][0]["byteOffset"] = ~std::uint64_t{0}; },
                 "accessor 0 has 3 elements, its bufferView 0");
  expect_refused([](Json& d) { d["bufferViews"][1]["byteOffset"] = ~std::uint64_t{0}; },
                 "bufferView 1 exceeds its buffer of 42 bytes");
  expect_refused([](Json& d) { d["bufferViews"][1]["byteLength"] = 7; },
                 "bufferView 1 exceeds its buffer of 42 bytes");
  expect_refused([](Json& d) { d["bufferViews"][0]["byteStride"] = 8; },
                 "accessor 0 has elements of 12 bytes every 8 bytes");
  expect_refused([](Json& d) { d["bufferViews"][0]["byteStride"] = std::uint64_t{1} << 63; },
                 "accessor 0 has elements of 12 bytes every 9223372036854775808 bytes");
  expect_refused(
      [](Json& d) {
        d["accessors"][0].erase("bufferView");
        d["accessors"][0]["count"] = 1000000;
      },
      "accessor 0 has 1000000 elements and no data");
  expect_refused([](Json& d) { d["accessors"][0]["type"] = "VEC2"; },
                 "accessor 0 has no positions");
  expect_refused([](Json& d) { d["accessors"][1]["type"] = "VEC3"; }, "accessor 1 has no indices");
  expect_refused([](Json& d) { d["accessors"][1]["componentType"] = 5122; },
                 "accessor 1 has no indices");
}

TEST(GltfRefusal, NamesSparseIndicesThatDoNotAscend) {
  for (const std::vector<std::uint32_t>& indices :
       {std::vector<std::uint32_t>{1, 1}, {2, 1}, {1, 3}}) {
    GltfWriter scene = small_scene();
    scene.document["accessors"][0]["sparse"] = {
        {"count", 2},
        {"indices",
         {{"bufferView", scene.view(GltfWriter::bytes_of(indices, Component::kUint8))},
          {"componentType", 5121}}},
        {"values", {{"bufferView", 0}}}};
    expect_refused(scene.glb(),
                   "accessor 0 has sparse indices that do not ascend, or are too large");
  }
}

// Nodes that are their own ancestors, or have two parents, would be placed without end or twice.
TEST(GltfRefusal, NamesNodesThatAreReachedTwice) {
  expect_refused(
      [](Json& d) {
        d["nodes"][0]["children"] = {0};
        d["scenes"] = {{{"nodes", {0}}}};
      },
      "node 0 is in the tree of nodes twice");
  expect_refused(
      [](Json& d) {
        d["scenes"] = {{{"nodes", {0, 0}}}};
      },
      "node 0 is in the tree of nodes twice");
}

TEST(GltfRefusal, NamesBuffersThatAreNotThere) {
  const GltfWriter scene = small_scene();
  expect_refused(scene.beside("http://example.org/a.bin"), "is no file beside the glTF");
  expect_refused(scene.beside("/etc/passwd"),
                 "the buffer '/etc/passwd' is no file beside the glTF");
  expect_refused(scene.beside("a%00b"), "is no file beside the glTF");
  expect_refused(scene.beside(""), "is no file beside the glTF");
  const Reading missing = read_bytes(scene.beside("not there.bin"), ".gltf");
  EXPECT_EQ(missing.code, ErrorCode::kNotFound);
  EXPECT_EQ(missing.error, "buffer 0, 'not there.bin': no such file; check the path");
  const TemporaryFile data(scene.buffer.str().substr(1), ".bin");
  expect_refused(scene.beside(data.path().filename().string()),
                 "buffer 0 declares 42 bytes and has 41: truncated");
  Json document = scene.document;
  document["buffers"] = Json::array({Json({{"byteLength", 42}})});
  expect_refused(document.dump(), "buffer 0 has neither a URI nor a binary chunk");
  expect_refused(scene.beside("data:,abc"), "buffer 0 embeds data that is not in base64");
}

TEST(GltfRefusal, NamesDamagedBase64) {
  const std::string whole = small_scene().embedded();
  const std::size_t data = whole.find("base64,") + 7;
  for (const auto& [part, message] : std::vector<std::pair<std::string, std::string>>{
           {"A", "truncated"}, {"A=", "not whole"}, {"AA=A", "no base64"}, {"A*AA", "no base64"}}) {
    std::string bytes = whole;
    bytes.replace(data, bytes.find('"', data) - data, part);
    expect_refused(bytes, part == "A" ? "the base64 of an embedded buffer is not whole" : message);
  }
}

TEST(GltfRefusal, NamesDamagedJson) {
  expect_refused("{\"asset\": {\"version\": \"2.0\"", "the JSON is damaged or ends here");
  expect_refused("{\"asset\": {\"version\": \"2.0\"}} more", "the JSON is damaged or ends here");
  expect_refused("{\"asset\": \"\xFF\"}", "the JSON is damaged or ends here");
  expect_refused("{\"asset\": {\"version\": \"2.0\"}}", "no triangle: the mesh has no faces");
  expect_refused("{ \"vertices\": [] }", "the file is a JSON file and no glTF", ".json");
  std::string deep = "{\"asset\": {\"version\": \"2.0\"}, \"nodes\": [{\"children\": ";
  deep += std::string(1000000, '[') + std::string(1000000, ']');
  expect_refused(deep + "}]}", "node 0 'children' is not a list of integers from 0");
}

TEST(GltfRefusal, LimitsRecordsAndText) {
  std::string many = "{\"asset\": {\"version\": \"2.0\"}, \"nodes\": [{}";
  for (int i = 0; i < (1 << 20); ++i) many += ",{}";
  expect_refused(many + "]}", "more than 1048576 nodes, meshes, accessors and references");
  std::string wide = "{\"asset\": {\"version\": \"2.0\"}, \"materials\": [0";
  const std::string name = ",\"" + std::string(4000, 'x') + '"';
  while (wide.size() <= (std::size_t{64} << 20)) wide += name;
  expect_refused(wide + "]}", "the JSON has more than 64 MiB without its buffers");
}

TEST(GltfRefusal, NamesDamagedChunks) {
  const std::string whole = small_scene().glb();
  const auto with = [&](std::size_t at, std::uint32_t value) {
    std::string bytes = whole;
    return bytes.replace(at, 4, Bytes().put(value).str());
  };
  const auto length = static_cast<std::uint32_t>(whole.size());
  expect_refused(with(8, length + 1), "byte 8: a GLB of " + std::to_string(length + 1) +
                                          " bytes in a file of " + std::to_string(length));
  expect_refused(with(8, 11), "byte 8: a GLB of 11 bytes");
  expect_refused(with(8, 16), "byte 12: the GLB ends within the header of a chunk");
  expect_refused(with(12, 0xFFFFFFFF), "byte 12: a chunk of 4294967295 bytes, where");
  expect_refused(with(16, 7), "byte 12: the first chunk of the GLB is not its JSON");
  expect_refused("glTF", "byte 4: the file ends within the header of a GLB");
  GltfWriter longer = small_scene();
  longer.buffer.text("12345678");
  std::string bytes = longer.glb();
  bytes.replace(bytes.find("\"byteLength\":50"), 15, "\"byteLength\":42");
  expect_refused(bytes, "the binary chunk has 52 bytes, buffer 0 declares 42");
}

// A compressed glTF is read from a temporary file, which has no other files beside it.
TEST(GltfRefusal, ReadsNoFileBesideACompressedGltf) {
  const GltfWriter scene = small_scene();
  // A gzip member with one stored block.
  const std::string text = scene.beside("a.bin");
  Bytes packed;
  packed.text(std::string_view("\x1f\x8b\x08\0\0\0\0\0\0\x03\x01", 11));
  packed.put(static_cast<std::uint16_t>(text.size()), static_cast<std::uint16_t>(~text.size()));
  packed.text(text);
  std::uint32_t crc = ~std::uint32_t{0};
  for (const char c : text) {
    crc ^= static_cast<unsigned char>(c);
    for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ (crc & 1 ? 0xEDB88320U : 0);
  }
  packed.put(~crc, static_cast<std::uint32_t>(text.size()));
  expect_refused(packed.str(), "the buffer 'a.bin' is beside a glTF that is compressed",
                 ".gltf.gz");
}

}  // namespace
}  // namespace planetree::octree
