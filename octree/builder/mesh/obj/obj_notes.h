#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "octree/builder/mesh/stream/mesh_note.h"

namespace planetree::octree {

/// Counts the statements of an OBJ that are not read and are no attributes of its faces.
class ObjNotes {
 public:
  /// Adds a statement that is not read. Attributes and comments are not counted.
  void add(std::uint64_t line, std::string_view keyword);
  /// A line for each kind of statement.
  [[nodiscard]] std::vector<std::string> texts() const;

 private:
  MeshNote points_and_lines_, free_forms_, unknown_;
};

}  // namespace planetree::octree
