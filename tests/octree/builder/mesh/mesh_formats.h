#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <cstdio>
#include <ostream>
#include <string>
#include <vector>

#include "tests/octree/builder/mesh/gltf/gltf_writer.h"
#include "tests/octree/builder/mesh/mesh_recorder.h"

/// One mesh, valid or not, written in every format that a reader knows.
namespace planetree::octree {

struct PlainMesh {
  std::vector<std::array<float, 3>> vertices;
  std::vector<std::vector<std::int64_t>> faces;  ///< vertex indices from 0, possibly out of range
};

/// The errors of the counts in a header.
struct CountError {
  std::int64_t vertices = 0, faces = 0;
};

struct MeshFormat {
  const char* name;
  const char* extension;
  bool has_counts;    ///< header counts faces and, if indexed, vertices
  bool is_indexed;    ///< faces refer to vertices by index instead of repeating them
  bool has_polygons;  ///< faces may have any number of corners
  bool is_text;
  bool has_end;  ///< no part of a file is a whole one, but for a last newline
  std::string (*write)(const PlainMesh& mesh, const CountError& lie);
};

inline void PrintTo(const MeshFormat& format, std::ostream* out) { *out << format.name; }

namespace mesh_formats {

inline std::string numbers(const std::array<float, 3>& vertex) {
  char text[96];
  std::snprintf(text, sizeof text, "%.9g %.9g %.9g\n", static_cast<double>(vertex[0]),
                static_cast<double>(vertex[1]), static_cast<double>(vertex[2]));
  return text;
}

inline std::string counted(const std::vector<std::int64_t>& face) {
  std::string line = std::to_string(face.size());
  for (const std::int64_t index : face) line += " " + std::to_string(index);
  return line + "\n";
}

inline std::int64_t certain(std::size_t count, std::int64_t lie) {
  return static_cast<std::int64_t>(count) + lie;
}

inline std::string text_body(const PlainMesh& mesh) {
  std::string text;
  for (const auto& vertex : mesh.vertices) text += numbers(vertex);
  for (const auto& face : mesh.faces) text += counted(face);
  return text;
}

/// Writes vertices and faces. Each face is followed by the bytes of its colour.
inline void put_body(Bytes& bytes, const PlainMesh& mesh, std::string_view face_colours) {
  for (const auto& [x, y, z] : mesh.vertices) bytes.put(x, y, z);
  for (const auto& face : mesh.faces) {
    bytes.put(static_cast<std::uint32_t>(face.size()));
    for (const std::int64_t index : face) bytes.put(static_cast<std::uint32_t>(index));
    bytes.text(face_colours);
  }
}

inline std::string ply_head(const std::string& encoding, const std::string& index_type,
                            const PlainMesh& mesh, const CountError& lie) {
  return "ply\nformat " + encoding + " 1.0\nelement vertex " +
         std::to_string(certain(mesh.vertices.size(), lie.vertices)) +
         "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
         std::to_string(certain(mesh.faces.size(), lie.faces)) + "\nproperty list uint " +
         index_type + " vertex_indices\nend_header\n";
}

inline std::string ply_ascii(const PlainMesh& mesh, const CountError& lie) {
  return ply_head("ascii", "int", mesh, lie) + text_body(mesh);
}

inline std::string ply_little(const PlainMesh& mesh, const CountError& lie) {
  Bytes bytes;
  put_body(bytes.text(ply_head("binary_little_endian", "int", mesh, lie)), mesh, "");
  return bytes.str();
}

inline std::string ply_big(const PlainMesh& mesh, const CountError& lie) {
  Bytes bytes(std::endian::big);
  put_body(bytes.text(ply_head("binary_big_endian", "uint", mesh, lie)), mesh, "");
  return bytes.str();
}

inline std::string off_ascii(const PlainMesh& mesh, const CountError& lie) {
  return "OFF\n" + std::to_string(certain(mesh.vertices.size(), lie.vertices)) + " " +
         std::to_string(certain(mesh.faces.size(), lie.faces)) + " 0\n" + text_body(mesh);
}

inline std::string off_binary(const PlainMesh& mesh, const CountError& lie) {
  Bytes bytes(std::endian::big);
  bytes.text("OFF BINARY\n");
  bytes.put(static_cast<std::int32_t>(certain(mesh.vertices.size(), lie.vertices)),
            static_cast<std::int32_t>(certain(mesh.faces.size(), lie.faces)), std::int32_t{0});
  put_body(bytes, mesh, std::string_view("\0\0\0\0", 4));
  return bytes.str();
}

inline std::string obj(const PlainMesh& mesh, const CountError&) {
  std::string text;
  for (const auto& vertex : mesh.vertices) text += "v " + numbers(vertex);
  for (const auto& face : mesh.faces) {
    text += "f";
    for (const std::int64_t index : face) text += " " + std::to_string(index + 1);
    text += "\n";
  }
  return text;
}

inline std::string stl_ascii(const PlainMesh& mesh, const CountError&) {
  std::vector<std::string> vertices;
  for (const auto& vertex : mesh.vertices) vertices.push_back("vertex " + numbers(vertex));
  std::string text = "solid\n";
  for (const auto& face : mesh.faces) {
    text += "facet normal 0 0 1\nouter loop\n";
    for (const std::int64_t index : face) text += vertices[static_cast<std::size_t>(index)];
    text += "endloop\nendfacet\n";
  }
  return text + "endsolid\n";
}

inline std::string stl_binary(const PlainMesh& mesh, const CountError& lie) {
  Bytes bytes;
  bytes.text(std::string(80, '\0'));
  bytes.put(static_cast<std::uint32_t>(certain(mesh.faces.size(), lie.faces)));
  for (const auto& face : mesh.faces) {
    bytes.put(0.0F, 0.0F, 1.0F);
    for (const std::int64_t index : face) {
      const auto& [x, y, z] = mesh.vertices[static_cast<std::size_t>(index)];
      bytes.put(x, y, z);
    }
    bytes.put(std::uint16_t{0});
  }
  return bytes.str();
}

inline std::string glb(const PlainMesh& mesh, const CountError&) {
  std::vector<std::uint32_t> corners;
  for (const auto& face : mesh.faces)
    for (const std::int64_t index : face) corners.push_back(static_cast<std::uint32_t>(index));
  GltfWriter scene;
  const std::size_t positions = scene.positions(mesh.vertices);
  scene.mesh({GltfWriter::primitive(positions, scene.indices(corners, Component::kUint32))});
  return scene.glb();
}

}  // namespace mesh_formats

/// The formats for which `holds` is true.
template <class Holds>
std::vector<MeshFormat> formats_that(const Holds& holds) {
  namespace f = mesh_formats;
  std::vector<MeshFormat> some;
  for (const MeshFormat& format : {
           MeshFormat{"PlyAscii", ".ply", true, true, true, true, true, f::ply_ascii},
           MeshFormat{"PlyLittleEndian", ".ply", true, true, true, false, true, f::ply_little},
           MeshFormat{"PlyBigEndian", ".ply", true, true, true, false, true, f::ply_big},
           MeshFormat{"StlAscii", ".stl", false, false, true, true, true, f::stl_ascii},
           MeshFormat{"StlBinary", ".stl", true, false, false, false, true, f::stl_binary},
           MeshFormat{"Obj", ".obj", false, true, true, true, false, f::obj},
           MeshFormat{"OffAscii", ".off", true, true, true, true, true, f::off_ascii},
           MeshFormat{"OffBinary", ".off", true, true, true, false, true, f::off_binary},
           MeshFormat{"Glb", ".glb", false, true, false, false, true, f::glb},
       })
    if (holds(format)) some.push_back(format);
  return some;
}

}  // namespace planetree::octree
