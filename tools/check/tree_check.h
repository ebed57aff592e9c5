#pragma once

#include <cstdint>

#include "tools/check/file_check.h"
#include "tools/check/file_parts.h"
#include "tools/check/geometry_check.h"

namespace planetree::tools {

/// What the header states of one of the file's trees.
struct TreeSection {
  bool is_of_caps = false;
  std::uint32_t first_page = 0, end_page = 0;
  std::uint8_t height = 0;
  std::uint64_t nodes = 0, blocks = 0, triangles = 0;
  std::uint64_t indices = 0;  // triangles have lesser indices

  static TreeSection of_surface(const FileParts& parts) {
    const storage::ModelRecord& model = parts.header()->model;
    return {false,
            0,
            parts.first_cap_page(),
            model.height,
            model.node_count,
            model.block_count,
            model.triangle_count,
            model.usable_triangles() + model.skipped_count};
  }
  static TreeSection of_caps(const FileParts& parts) {
    const storage::ModelRecord& model = parts.header()->model;
    return {true,
            parts.first_cap_page(),
            parts.first_field_page(),
            model.cap_height,
            model.cap_node_count,
            model.cap_block_count,
            model.cap_count,
            model.cap_count};
  }
};

/// Checks the pages of one tree, and counts what it finds in the report.
///
/// geometry  null: only the structure is checked
/// return    whether all pages were readable and all links led to records
bool check_tree(FileParts& parts, const TreeSection& section, GeometryCheck* geometry,
                CheckReport& report, const CheckProgress& progress);

}  // namespace planetree::tools
