#pragma once

#include "octree/builder/mesh/mesh_reader.h"
#include "octree/builder/mesh/ply_attributes.h"
#include "octree/builder/mesh/ply_header.h"
#include "octree/builder/mesh/stream/mesh_file.h"
#include "octree/builder/mesh/stream/mesh_scratch.h"

namespace planetree::octree {

/// Reads a PLY file (is_ply()): ascii or binary, elements in any order.
/// Contract as read_mesh().
Result<MeshSummary> read_ply(const MeshFile& file, TriangleSink& sink, MeshScratch& scratch,
                             const MeshOptions& options = {});

/// Reads the records that `header` describes, whatever the format of the file is.
/// Contract as read_mesh().
Result<MeshSummary> read_ply_body(const MeshFile& file, const PlyHeader& header, TriangleSink& sink,
                                  MeshScratch& scratch, const PlyAttributes& attributes = {});

}  // namespace planetree::octree
