#pragma once

#include "octree/builder/mesh/mesh_size.h"
#include "octree/builder/mesh/stream/triangle_sink.h"
#include "planetree/build.h"
#include "planetree/error.h"

/// Triangles from a callback of the caller.
namespace planetree::octree {

/// Size by the number of triangles that are expected: half as many vertices, as a closed surface
/// has. Zero if nothing is known.
MeshSize size_of_stream(const BuildInput::Stream& stream);

/// Reads all triangles. Contract as read_mesh(). Progress is counted in bytes of their corners; the
/// total grows where more triangles come than were expected.
///
/// errors  also those of the callback; kBadInput where it throws or gives more than was asked for.
Result<MeshSummary> read_stream(const BuildInput::Stream& stream, TriangleSink& sink);

}  // namespace planetree::octree
