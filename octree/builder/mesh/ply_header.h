#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "octree/builder/mesh/ply_scalar.h"
#include "octree/builder/mesh/stream/mesh_text.h"
#include "planetree/error.h"

namespace planetree::octree {

enum class PlyEncoding : std::uint8_t { kAscii, kBinaryLittleEndian, kBinaryBigEndian };

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::kFloat32;  ///< of the value, or of a list's items
  bool is_list = false;
  PlyType count_type = PlyType::kUint8;  ///< of a list's length; an integer type
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;  ///< as declared: nothing is known of the body yet
  std::vector<PlyProperty> properties;

  [[nodiscard]] bool has_list() const noexcept;
  /// Bytes of one binary record in front of property `index`; no list among them.
  [[nodiscard]] std::uint64_t offset_of(std::size_t index) const noexcept;
  /// Fewest bytes of one binary record: that of one whose lists are empty.
  [[nodiscard]] std::uint64_t min_record_bytes() const noexcept;
};

/// What the header says, with the parts a mesh needs found and checked. Other
/// formats whose records follow one another so are described by it too.
struct PlyHeader {
  PlyEncoding encoding = PlyEncoding::kAscii;
  /// Of ascii: words may follow a record's last value, the same number of them
  /// every vertex's, and '#' begins a comment.
  bool has_loose_lines = false;
  std::vector<PlyElement> elements;
  std::size_t vertex_element = 0;               ///< position in `elements`
  std::size_t face_element = 0;                 ///< position in `elements`
  std::array<std::size_t, 3> coordinates = {};  ///< x, y, z: positions in the vertex's properties
  std::size_t index_list = 0;                   ///< position in the face's properties
  TextPosition body;                            ///< where the first record begins

  [[nodiscard]] const PlyElement& vertices() const { return elements[vertex_element]; }
  [[nodiscard]] const PlyElement& faces() const { return elements[face_element]; }
  [[nodiscard]] PlyType coordinate_type(std::size_t axis) const {
    return vertices().properties[coordinates[axis]].type;
  }
  /// Whether float32 holds every coordinate of the declared types.
  [[nodiscard]] bool float32() const;
};

/// Whether the first word of a file, of which this is the front, is PLY's.
bool is_ply(std::string_view file) noexcept;

/// Reads the header of a file that is_ply(), of which this is the front. Trusts no
/// count: they are checked against the body by whoever reads it. kBadInput names the line.
Result<PlyHeader> parse_ply_header(std::string_view file);

}  // namespace planetree::octree
