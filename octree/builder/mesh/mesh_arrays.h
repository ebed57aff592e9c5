#pragma once

#include <cstdint>

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
/// Texture coordinates that may be both of vertices and of corners are of vertices.
///
/// keep    as MeshOptions::keep.
/// errors  also kBadArgument: an array of attributes that are kept has a wrong size.
Result<MeshSummary> read_arrays(const BuildInput::Mesh<Vec3>& mesh, TriangleSink& sink,
                                std::uint32_t keep = 0);
Result<MeshSummary> read_arrays(const BuildInput::Mesh<FloatVertex>& mesh, TriangleSink& sink,
                                std::uint32_t keep = 0);

}  // namespace planetree::octree
