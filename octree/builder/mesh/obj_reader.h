#pragma once

#include "octree/builder/mesh/mesh_reader.h"
#include "octree/builder/mesh/stream/mesh_file.h"
#include "octree/builder/mesh/stream/mesh_scratch.h"

namespace planetree::octree {

/// Reads the v and f statements of an OBJ and passes over all others. An f may
/// name vertices by number from 1, by number back from the last v so far (-1),
/// and ones that follow it; texture and normal numbers are not read.
/// Contract as read_mesh; reads the file twice.
Result<MeshSummary> read_obj(const MeshFile& file, TriangleSink& sink, MeshScratch& scratch);

}  // namespace planetree::octree
