#include "octree/builder/mesh/mesh_arrays.h"

#include <algorithm>

#include "octree/builder/mesh/stream/fan_emitter.h"

namespace planetree::octree {
namespace {

Vec3 position_of(const Vec3& vertex) { return vertex; }
Vec3 position_of(const FloatVertex& vertex) { return {vertex[0], vertex[1], vertex[2]}; }

// A coordinate that is not finite belongs to no triangle that is built.
bool fits_float(double value) {
  return !(static_cast<double>(static_cast<float>(value)) != value && value == value);
}

template <class Vertex>
Result<MeshSummary> read(const BuildInput::Mesh<Vertex>& mesh, bool float32, TriangleSink& sink) {
  FanEmitter emitter(sink, RecordKind::kFace, mesh.triangles.size_bytes());
  emitter.set_vertex_count(mesh.vertices.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const TriangleVertices& indices = mesh.triangles[i];
    const auto corner_at = [&mesh, &indices](std::uint64_t k) {
      const std::uint32_t index = indices[static_cast<std::size_t>(k)];
      if (index >= mesh.vertices.size()) return MeshCorner{{}, index, false};
      return MeshCorner{position_of(mesh.vertices[index]), index, true};
    };
    if (const auto taken = emitter.polygon(i, 3, corner_at); !taken) return taken.error();
    const auto told = emitter.advance((i + 1) * sizeof(TriangleVertices));
    if (!told) return told.error();
  }
  return emitter.finish(float32);
}

}  // namespace

MeshSize size_of_arrays(const BuildInput::Mesh<Vec3>& mesh) {
  const bool float32 = std::ranges::all_of(mesh.vertices, [](const Vec3& v) {
    return fits_float(v.x) && fits_float(v.y) && fits_float(v.z);
  });
  return {mesh.triangles.size(), mesh.vertices.size(), !float32};
}

MeshSize size_of_arrays(const BuildInput::Mesh<FloatVertex>& mesh) {
  return {mesh.triangles.size(), mesh.vertices.size(), false};
}

Result<MeshSummary> read_arrays(const BuildInput::Mesh<Vec3>& mesh, TriangleSink& sink) {
  return read(mesh, false, sink);
}

Result<MeshSummary> read_arrays(const BuildInput::Mesh<FloatVertex>& mesh, TriangleSink& sink) {
  return read(mesh, true, sink);
}

}  // namespace planetree::octree
