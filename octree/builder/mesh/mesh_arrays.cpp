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

Error size_error(const char* what, std::size_t size, const char* of, std::size_t count) {
  return make_error(ErrorCode::kBadArgument, Error::kNowhere, Error::kNowhere,
                    "%zu %s for %zu %s; give as many, or do not keep them", size, what, count, of);
}

/// Attributes of the vertices and triangles of a mesh, of which `keep` names those that are read.
template <class Vertex>
class ArrayAttributes {
 public:
  ArrayAttributes(const BuildInput::Mesh<Vertex>& mesh, std::uint32_t keep)
      : mesh_(mesh), keep_(keep), are_uvs_of_vertices_(mesh.uvs.size() == mesh.vertices.size()) {}

  [[nodiscard]] Result<void> check() const {
    const std::size_t vertices = mesh_.vertices.size(), triangles = mesh_.triangles.size();
    if (keeps(kKeepColor) && mesh_.colors.size() != vertices)
      return size_error("colors", mesh_.colors.size(), "vertices", vertices);
    if (keeps(kKeepUv) && !are_uvs_of_vertices_ && mesh_.uvs.size() != 3 * triangles)
      return make_error(ErrorCode::kBadArgument, Error::kNowhere, Error::kNowhere,
                        "%zu uvs for %zu vertices and %zu triangles; give one for each vertex or "
                        "three for each triangle, or do not keep them",
                        mesh_.uvs.size(), vertices, triangles);
    if (keeps(kKeepValue) && mesh_.values.size() != triangles)
      return size_error("values", mesh_.values.size(), "triangles", triangles);
    return {};
  }

  /// Those of corner k of a triangle, whose vertex exists.
  [[nodiscard]] CornerAttributes of_corner(std::size_t triangle, std::size_t k,
                                           std::uint32_t vertex) const {
    CornerAttributes attributes;
    if (keeps(kKeepColor)) attributes.color = mesh_.colors[vertex];
    if (keeps(kKeepUv)) attributes.uv = mesh_.uvs[are_uvs_of_vertices_ ? vertex : 3 * triangle + k];
    return attributes;
  }
  [[nodiscard]] std::uint64_t value_of(std::size_t triangle) const {
    return keeps(kKeepValue) ? mesh_.values[triangle] : 0;
  }

 private:
  [[nodiscard]] bool keeps(std::uint32_t attribute) const { return (keep_ & attribute) != 0; }

  const BuildInput::Mesh<Vertex>& mesh_;
  const std::uint32_t keep_;
  const bool are_uvs_of_vertices_;
};

template <class Vertex>
Result<MeshSummary> read(const BuildInput::Mesh<Vertex>& mesh, bool float32, TriangleSink& sink,
                         std::uint32_t keep) {
  const ArrayAttributes<Vertex> attributes(mesh, keep);
  if (const auto checked = attributes.check(); !checked) return checked.error();
  FanEmitter emitter(sink, RecordKind::kFace, mesh.triangles.size_bytes());
  emitter.set_keep(keep);
  emitter.set_vertex_count(mesh.vertices.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const TriangleVertices& indices = mesh.triangles[i];
    const auto corner_at = [&mesh, &indices, &attributes, i, keep](std::uint64_t k) {
      const std::uint32_t index = indices[static_cast<std::size_t>(k)];
      if (index >= mesh.vertices.size()) return MeshCorner{{}, index, false};
      MeshCorner corner{position_of(mesh.vertices[index]), index, true};
      if (keep != 0)
        corner.attributes = attributes.of_corner(i, static_cast<std::size_t>(k), index);
      return corner;
    };
    emitter.set_value(attributes.value_of(i));
    if (const auto taken = emitter.polygon(i, 3, corner_at); !taken) return taken.error();
    const auto told = emitter.advance((i + 1) * sizeof(TriangleVertices));
    if (!told) return told.error();
  }
  Result<MeshSummary> summary = emitter.finish(float32);
  if (summary) summary->value_kind = mesh.value_kind;
  return summary;
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

Result<MeshSummary> read_arrays(const BuildInput::Mesh<Vec3>& mesh, TriangleSink& sink,
                                std::uint32_t keep) {
  return read(mesh, false, sink, keep);
}

Result<MeshSummary> read_arrays(const BuildInput::Mesh<FloatVertex>& mesh, TriangleSink& sink,
                                std::uint32_t keep) {
  return read(mesh, true, sink, keep);
}

}  // namespace planetree::octree
