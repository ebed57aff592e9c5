#pragma once

#include <cstdint>

#include "octree/builder/mesh/stream/mesh_file.h"
#include "octree/builder/mesh/stream/mesh_scratch.h"
#include "octree/builder/mesh/stream/triangle_sink.h"
#include "planetree/error.h"

namespace planetree::octree {

/// Reads the v and f statements of an OBJ. An f, or its old name fo, names a vertex by its number
/// from 1, or by a negative number that counts back from the last v so far (-1). It may name
/// vertices that follow it. Normal numbers are not read. Statements that carry geometry that is not
/// read, and unknown ones, are noted.
/// Contract as read_mesh(); reads the file twice.
///
/// keep  as MeshOptions::keep. Colours are the last three numbers of "v x y z r g b". Texture
///       coordinates are those of the vt that an f names behind its vertex; a corner that names
///       none has zeros, and its face is noted.
Result<MeshSummary> read_obj(const MeshFile& file, TriangleSink& sink, MeshScratch& scratch,
                             std::uint32_t keep = 0);

}  // namespace planetree::octree
