#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "tests/octree/builder/mesh/mesh_recorder.h"

/// Writes glTF files for tests.
namespace planetree::octree {

/// Component types of glTF.
enum class Component : int { kInt8 = 5120, kUint8, kInt16, kUint16, kUint32 = 5125, kFloat = 5126 };

using Position = std::array<float, 3>;

/// A glTF that grows: buffers hold what accessors need, in the order in which they are added.
class GltfWriter {
 public:
  nlohmann::json document = {{"asset", {{"version", "2.0"}}}};
  Bytes buffer;

  /// A view of bytes that are put behind those there are. A stride of 0 is not written.
  std::size_t view(const Bytes& bytes, std::size_t stride = 0) {
    while (buffer.str().size() % 4 != 0) buffer.put(std::uint8_t{0xAA});
    nlohmann::json made = {
        {"buffer", 0}, {"byteOffset", buffer.str().size()}, {"byteLength", bytes.str().size()}};
    if (stride != 0) made["byteStride"] = stride;
    buffer.text(bytes.str());
    return add("bufferViews", made);
  }

  std::size_t accessor(std::size_t view, Component component, std::size_t count,
                       const char* type = "VEC3", std::size_t offset = 0) {
    nlohmann::json made = {{"bufferView", view},
                           {"componentType", static_cast<int>(component)},
                           {"count", count},
                           {"type", type}};
    if (offset != 0) made["byteOffset"] = offset;
    return add("accessors", made);
  }

  std::size_t positions(const std::vector<Position>& positions) {
    return accessor(view(bytes_of(positions)), Component::kFloat, positions.size());
  }
  static Bytes bytes_of(const std::vector<Position>& positions) {
    Bytes bytes;
    for (const auto& [x, y, z] : positions) bytes.put(x, y, z);
    return bytes;
  }

  std::size_t indices(const std::vector<std::uint32_t>& indices, Component component) {
    return accessor(view(bytes_of(indices, component)), component, indices.size(), "SCALAR");
  }
  static Bytes bytes_of(const std::vector<std::uint32_t>& indices, Component component) {
    Bytes bytes;
    for (const std::uint32_t index : indices) {
      if (component == Component::kUint8) bytes.put(static_cast<std::uint8_t>(index));
      if (component == Component::kUint16) bytes.put(static_cast<std::uint16_t>(index));
      if (component == Component::kUint32) bytes.put(index);
    }
    return bytes;
  }

  static nlohmann::json primitive(std::size_t positions) {
    return {{"attributes", {{"POSITION", positions}}}};
  }
  static nlohmann::json primitive(std::size_t positions, std::size_t indices) {
    nlohmann::json made = primitive(positions);
    made["indices"] = indices;
    return made;
  }
  std::size_t mesh(const std::vector<nlohmann::json>& primitives) {
    return add("meshes", {{"primitives", primitives}});
  }
  std::size_t node(const nlohmann::json& made) { return add("nodes", made); }

  std::size_t add(const char* list, const nlohmann::json& made) {
    document[list].push_back(made);
    return document[list].size() - 1;
  }

  /// The file in its forms. Without scenes or nodes the reader shows all that there is.
  [[nodiscard]] std::string glb() const {
    nlohmann::json whole = document;
    if (!buffer.str().empty()) whole["buffers"].push_back({{"byteLength", buffer.str().size()}});
    std::string json = whole.dump();
    json.resize((json.size() + 3) / 4 * 4, ' ');
    std::string binary = buffer.str();
    binary.resize((binary.size() + 3) / 4 * 4, '\0');
    Bytes bytes;
    const std::size_t chunk_bytes = binary.empty() ? 0 : 8 + binary.size();
    bytes.text("glTF").put(std::uint32_t{2},
                           static_cast<std::uint32_t>(20 + json.size() + chunk_bytes));
    bytes.put(static_cast<std::uint32_t>(json.size())).text("JSON").text(json);
    if (!binary.empty())
      bytes.put(static_cast<std::uint32_t>(binary.size()))
          .text(std::string_view("BIN\0", 4))
          .text(binary);
    return bytes.str();
  }
  [[nodiscard]] std::string embedded(const std::string& slash = "/") const {
    std::string data;
    for (const char c : base64(buffer.str())) data += c == '/' ? slash : std::string(1, c);
    nlohmann::json whole = document;
    whole["buffers"].push_back({{"byteLength", buffer.str().size()}, {"uri", "PUT"}});
    std::string text = whole.dump(2);
    return text.replace(text.find("PUT"), 3, "data:application/octet-stream;base64," + data);
  }
  /// With its buffer in another file.
  [[nodiscard]] std::string beside(const std::string& uri) const {
    nlohmann::json whole = document;
    whole["buffers"].push_back({{"byteLength", buffer.str().size()}, {"uri", uri}});
    return whole.dump();
  }

  static std::string base64(std::string_view bytes) {
    constexpr std::string_view kDigits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
      unsigned group = 0;
      for (std::size_t k = 0; k < 3; ++k)
        group = group << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
      for (std::size_t k = 0; k < 4; ++k)
        text += i + k > bytes.size() ? '=' : kDigits[group >> (18 - 6 * k) & 63];
    }
    return text;
  }
};

/// The log of reading triangles, given as indices of positions, from a PLY of doubles.
inline std::string ply_log(const std::vector<std::array<double, 3>>& vertices,
                           const std::vector<std::array<std::uint32_t, 3>>& triangles) {
  Bytes bytes;
  bytes.text("ply\nformat binary_little_endian 1.0\nelement vertex " +
             std::to_string(vertices.size()) +
             "\nproperty double x\nproperty double y\nproperty double z\nelement face " +
             std::to_string(triangles.size()) + "\nproperty list uchar uint vertex_indices\n" +
             "end_header\n");
  for (const auto& [x, y, z] : vertices) bytes.put(x, y, z);
  for (const auto& [a, b, c] : triangles) bytes.put(std::uint8_t{3}, a, b, c);
  return read_bytes(bytes.str(), ".ply").log;
}

}  // namespace planetree::octree
