#pragma once

#include <string_view>

#include "octree/builder/mesh/mesh_reader.h"
#include "octree/builder/mesh/ply_header.h"
#include "octree/builder/mesh/stream/mesh_file.h"
#include "octree/builder/mesh/stream/mesh_scratch.h"

namespace planetree::octree {

/// Whether the first word of a file, of which this is the front, comments aside, is a keyword of
/// an OFF.
bool is_off(std::string_view file) noexcept;

/// What the header of a file says, of which this is the front, its records described as a PLY's
/// are.
/// errors  kBadInput.
Result<PlyHeader> parse_off_header(std::string_view file);

/// Reads an OFF, with or without a keyword, as Geomview defines it and others
/// write it: ascii, one vertex or face a line, or big-endian binary. Normals,
/// colours and texture coordinates are not read, nor is the number of edges.
/// Refuses vertices of other than three dimensions (4OFF, nOFF).
/// Contract as read_mesh.
Result<MeshSummary> read_off(const MeshFile& file, TriangleSink& sink, MeshScratch& scratch);

}  // namespace planetree::octree
