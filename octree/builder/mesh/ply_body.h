#pragma once

#include <string>
#include <vector>

#include "octree/builder/mesh/ply_header.h"
#include "octree/builder/mesh/stream/mesh_text.h"
#include "planetree/error.h"

namespace planetree::octree {

/// The records of a PLY file behind its header, in one encoding. Each call takes the position where
/// an element begins, and returns the position behind the element.
class PlyBody {
 public:
  virtual ~PlyBody() = default;

  /// Passes over all records of `element`.
  virtual Result<TextPosition> skip(const PlyElement& element, TextPosition begin) = 0;
  /// Finds or reads the vertices. Call it once, before faces().
  virtual Result<TextPosition> vertices(TextPosition begin) = 0;
  /// Delivers the faces or the triangles of strips.
  virtual Result<TextPosition> faces(TextPosition begin) = 0;
  /// Refuses records that no element declares: a count in the header is wrong then.
  virtual Result<void> expect_end(TextPosition end) = 0;
  /// What was read in another way than it is written, as MeshSummary::notes.
  [[nodiscard]] virtual std::vector<std::string> notes() const = 0;
};

}  // namespace planetree::octree
