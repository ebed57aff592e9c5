#pragma once

#include <cstdint>
#include <string_view>

#include "octree/builder/mesh/mesh_reader.h"
#include "octree/builder/mesh/stream/mesh_file.h"

namespace planetree::octree {

/// Whether the size is exactly that of a binary STL with the count that the front has.
bool has_binary_stl_size(std::string_view prefix, std::uint64_t size_bytes) noexcept;

/// Whether a file, of which this is the front, begins with "solid" and then goes on as text: binary
/// files may begin so too, but have zero bytes in or near their count.
bool is_ascii_stl(std::string_view file) noexcept;

/// Reads a binary STL. Fewer than 50 bytes behind the last facet are passed
/// over, since no facet fits in them; more mean that the count lies.
/// Contract as read_mesh.
Result<MeshSummary> read_stl_binary(const MeshFile& file, TriangleSink& sink);

/// Reads an ascii STL of one or more solids, keywords in any case. Normals are
/// not read. A facet of other than three vertices is a polygon.
/// Contract as read_mesh.
Result<MeshSummary> read_stl_ascii(const MeshFile& file, TriangleSink& sink);

}  // namespace planetree::octree
