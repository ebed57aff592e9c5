#pragma once

#include "octree/builder/mesh/mesh_reader.h"
#include "octree/builder/mesh/stream/mesh_file.h"
#include "octree/builder/mesh/stream/mesh_scratch.h"

namespace planetree::octree {

/// Reads the v and f statements of an OBJ. An f, or its old name fo, names a vertex by its number
/// from 1, or by a negative number that counts back from the last v so far (-1). It may name
/// vertices that follow it. Texture and normal numbers are not read. Statements that carry geometry
/// that is not read, and unknown ones, are noted.
/// Contract as read_mesh(); reads the file twice.
Result<MeshSummary> read_obj(const MeshFile& file, TriangleSink& sink, MeshScratch& scratch);

}  // namespace planetree::octree
