#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "octree/builder/mesh/ply_header.h"
#include "octree/builder/mesh/stream/corner_attributes.h"
#include "octree/builder/mesh/stream/mesh_note.h"
#include "octree/builder/mesh/stream/scalar_type.h"
#include "planetree/attributes.h"
#include "planetree/error.h"

namespace planetree::octree {

/// Where a PLY has the attributes that are kept. Properties are named by their indices in the
/// vertex or the face.
struct PlyAttributes {
  /// Numbers of a vertex that attributes need at most: four channels of a colour, u and v.
  static constexpr std::size_t kMaxNumbers = 6;

  std::uint32_t keep = 0;         ///< of kMeshAttributes
  std::uint32_t of_vertices = 0;  ///< those of them that vertices have
  /// Properties of a vertex: the three or four channels of a colour, then u and v, as of_vertices
  /// says.
  std::vector<std::size_t> vertex_numbers;
  std::vector<std::size_t> face_color;  ///< three or four channels, or none
  std::optional<std::size_t> face_uvs;  ///< a list of two numbers for each corner
  std::optional<std::size_t> value;
  ValueKind value_kind = ValueKind::kUnsigned;

  /// Whether faces have some of them.
  [[nodiscard]] bool of_faces() const { return !face_color.empty() || face_uvs || value; }
};

/// Finds the attributes that `keep` names. Those of vertices are preferred to those of faces.
/// Triangle strips have those of vertices alone.
///
/// errors  kBadInput: the PLY lacks one of them.
Result<PlyAttributes> find_attributes(const PlyHeader& header, std::uint32_t keep,
                                      const std::string& value_property);

/// A colour of numbers as the file has them.
///
/// properties  the three or four channels in `element`; their types say what the numbers mean:
///             shares of 1 as reals, of 65535 in 16 bits without sign, and otherwise of 255.
/// numbers     as many.
Color color_of(const PlyElement& element, std::span<const std::size_t> properties,
               std::span<const double> numbers);

/// The attributes of a vertex, of the numbers of PlyAttributes::vertex_numbers.
CornerAttributes vertex_attributes(const PlyHeader& header, const PlyAttributes& attributes,
                                   std::span<const double> numbers);

/// The kind of the values of a type.
ValueKind kind_of(ScalarType type);
/// Reads a value as TriangleAttributes has it.
std::uint64_t load_value(ScalarType type, const std::byte* at, bool swap);

/// Adds the note on faces whose list of texture coordinates has a wrong length, if there are any.
void add_uv_note(const RecordNote& wrong, std::vector<std::string>& notes);

}  // namespace planetree::octree
