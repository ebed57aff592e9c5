#pragma once

#include "octree/builder/mesh/mesh_size.h"
#include "octree/builder/mesh/stream/triangle_sink.h"
#include "planetree/build.h"
#include "planetree/error.h"

/// Meshes in memory.
namespace planetree::octree {

/// Size of a mesh in memory. It is exact; for double coordinates all vertices are looked at.
MeshSize size_of_arrays(const BuildInput::Mesh<Vec3>& mesh);
MeshSize size_of_arrays(const BuildInput::Mesh<FloatVertex>& mesh);

/// Reads a mesh in memory. Contract as read_mesh(). Progress is counted in bytes of the triangles.
Result<MeshSummary> read_arrays(const BuildInput::Mesh<Vec3>& mesh, TriangleSink& sink);
Result<MeshSummary> read_arrays(const BuildInput::Mesh<FloatVertex>& mesh, TriangleSink& sink);

}  // namespace planetree::octree
