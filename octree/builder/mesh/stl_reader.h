#pragma once

#include <cstdint>
#include <string_view>

#include "octree/builder/mesh/mesh_reader.h"
#include "octree/builder/mesh/stream/mesh_file.h"

namespace planetree::octree {

/// Whether the size of a file is that of a binary STL with the number of facets in `prefix`.
bool has_binary_stl_size(std::string_view prefix, std::uint64_t size_bytes) noexcept;

/// Whether a file begins with "solid" and goes on as text. Binary files may begin so too, but have
/// zero bytes in or near their count.
/// file  front of the file.
bool is_ascii_stl(std::string_view file) noexcept;

/// Reads a binary STL: 80 bytes that mean nothing here, a count, and the facets. A facet has 50
/// bytes, the last two of which are a number that means nothing here. There are three ways to fill
/// a file:
///   the count implies the size of the file;
///   every facet is followed by as many bytes as its last two say, and these end the file too;
///   zero bytes or white space follow the last facet. They are noted.
/// Other sizes are refused.
/// Contract as read_mesh().
Result<MeshSummary> read_stl_binary(const MeshFile& file, TriangleSink& sink);

/// Reads an ascii STL of one or more solids, with keywords in any case; "end solid" is "endsolid".
/// Normals are not read. A facet of other than three vertices is read as a polygon. Lines between
/// facets that begin with no keyword, text behind a solid, and a missing "endsolid" are noted.
/// Contract as read_mesh().
Result<MeshSummary> read_stl_ascii(const MeshFile& file, TriangleSink& sink);

}  // namespace planetree::octree
