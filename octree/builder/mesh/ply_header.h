#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "octree/builder/mesh/stream/mesh_text.h"
#include "octree/builder/mesh/stream/scalar_type.h"
#include "planetree/error.h"

namespace planetree::octree {

enum class PlyEncoding : std::uint8_t { kAscii, kBinaryLittleEndian, kBinaryBigEndian };

struct PlyProperty {
  std::string name;
  ScalarType type = ScalarType::kFloat32;  ///< type of the value, or of a list's items
  bool is_list = false;
  ScalarType count_type = ScalarType::kUint8;  ///< type of a list's length; an integer type
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;  ///< as declared; not checked against the body
  std::vector<PlyProperty> properties;

  [[nodiscard]] bool has_list() const noexcept;
  /// Offset of property `index` in a binary record. No list may precede it.
  [[nodiscard]] std::uint64_t offset_of(std::size_t index) const noexcept;
  /// Length of a binary record with empty lists: the minimum.
  [[nodiscard]] std::uint64_t min_record_bytes() const noexcept;
};

/// Contents of a header, with the parts that a mesh needs found and checked. It also describes
/// other formats whose records follow one another in the same way.
struct PlyHeader {
  PlyEncoding encoding = PlyEncoding::kAscii;
  /// Ascii only: each record begins a line, further words may follow its last value, as many for
  /// each vertex, and '#' begins a comment.
  bool has_loose_lines = false;
  /// Where records with loose lines turn out not to begin lines: the numbers behind the coordinates
  /// of a vertex; nothing if that is not known.
  std::optional<std::size_t> numbers_behind_vertex;
  std::vector<PlyElement> elements;
  std::size_t vertex_element = 0;               ///< index in `elements`
  std::size_t face_element = 0;                 ///< index in `elements`; of strips or of faces
  bool has_strips = false;                      ///< the "faces" are triangle strips
  std::array<std::size_t, 3> coordinates = {};  ///< x, y, z: indices in the vertex's properties
  std::size_t index_list = 0;                   ///< index in the face's or strip's properties
  TextPosition body;                            ///< position of the first record

  [[nodiscard]] const PlyElement& vertices() const { return elements[vertex_element]; }
  [[nodiscard]] const PlyElement& faces() const { return elements[face_element]; }
  [[nodiscard]] ScalarType coordinate_type(std::size_t axis) const {
    return vertices().properties[coordinates[axis]].type;
  }
  /// Whether float32 holds every value of the declared coordinate types.
  [[nodiscard]] bool float32() const;
  /// Declares the coordinates of an ascii body as doubles.
  void widen_text();
};

/// Whether the first word of a file is that of a PLY.
/// file  front of the file.
bool is_ply(std::string_view file) noexcept;

/// Parses the header of a file that is_ply(). Counts are not checked: the reader of the body checks
/// them against the file.
///
/// file    front of the file.
/// errors  kBadInput; the text names the line.
Result<PlyHeader> parse_ply_header(std::string_view file);

}  // namespace planetree::octree
