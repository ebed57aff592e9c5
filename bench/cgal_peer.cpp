#include "bench/peer_kinds.h"

#include <cmath>
#include <optional>

#include <CGAL/AABB_face_graph_triangle_primitive.h>
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Side_of_triangle_mesh.h>
#include <CGAL/Surface_mesh.h>

namespace planetree::bench {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Mesh = CGAL::Surface_mesh<Point>;
using Primitive = CGAL::AABB_face_graph_triangle_primitive<Mesh>;
using AabbTree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

Mesh surface_of(const PeerMesh& mesh) {
  Mesh surface;
  const auto point = [&](std::uint32_t vertex) {
    const float* const position = &mesh.positions[3 * std::size_t{vertex}];
    return Point(position[0], position[1], position[2]);
  };
  for (std::uint32_t i = 0; i < mesh.positions.size() / 3; ++i) surface.add_vertex(point(i));
  for (std::size_t i = 0; i < mesh.corners.size(); i += 3) {
    const std::uint32_t a = mesh.corners[i], b = mesh.corners[i + 1], c = mesh.corners[i + 2];
    const auto face =
        surface.add_face(Mesh::Vertex_index(a), Mesh::Vertex_index(b), Mesh::Vertex_index(c));
    // A face that would make the surface non-manifold gets vertices of its own.
    if (face == Mesh::null_face())
      surface.add_face(surface.add_vertex(point(a)), surface.add_vertex(point(b)),
                       surface.add_vertex(point(c)));
  }
  return surface;
}

class CgalPeer final : public Peer {
 public:
  explicit CgalPeer(const PeerMesh& mesh) : surface_(surface_of(mesh)) {
    tree_.insert(faces(surface_).first, faces(surface_).second, surface_);
    tree_.build();
    tree_.accelerate_distance_queries();
    side_.emplace(tree_);
  }

  [[nodiscard]] std::string name() const override { return "CGAL"; }
  double distance(const Vec3& query) override {
    return std::sqrt(tree_.squared_distance(Point(query.x, query.y, query.z)));
  }
  bool inside(const Vec3& query) override {
    return (*side_)(Point(query.x, query.y, query.z)) != CGAL::ON_UNBOUNDED_SIDE;
  }

 private:
  Mesh surface_;
  AabbTree tree_;
  std::optional<CGAL::Side_of_triangle_mesh<Mesh, Kernel>> side_;  // needs a built tree
};

}  // namespace

std::unique_ptr<Peer> make_cgal_peer(const PeerMesh& mesh) {
  return std::make_unique<CgalPeer>(mesh);
}

}  // namespace planetree::bench
