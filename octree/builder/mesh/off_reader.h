#pragma once

#include <string_view>

#include "octree/builder/mesh/mesh_reader.h"
#include "octree/builder/mesh/ply_header.h"
#include "octree/builder/mesh/stream/mesh_file.h"
#include "octree/builder/mesh/stream/mesh_scratch.h"

namespace planetree::octree {

/// Whether the first word of a file, after comments, is the keyword of an OFF.
/// file  front of the file.
bool is_off(std::string_view file) noexcept;

/// Parses the header of an OFF, and describes its records as those of a PLY.
///
/// file    front of the file.
/// errors  kBadInput.
Result<PlyHeader> parse_off_header(std::string_view file);

/// Reads an OFF, with or without a keyword, as Geomview defines it and as others write it: ascii
/// with one vertex or face a line or as words, whatever the lines are; or big-endian binary.
/// Normals, colours, texture coordinates and the number of edges are not read. Vertices with other
/// than three dimensions (4OFF, nOFF) are refused. Contract as read_mesh().
Result<MeshSummary> read_off(const MeshFile& file, TriangleSink& sink, MeshScratch& scratch);

}  // namespace planetree::octree
