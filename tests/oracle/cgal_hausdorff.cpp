#include "tests/oracle/cgal_hausdorff.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/distance.h>
#include <CGAL/Surface_mesh.h>

namespace planetree::oracle {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;

Mesh mesh_of(std::span<const Corners> triangles) {
  Mesh mesh;
  for (const Corners& triangle : triangles) {
    Mesh::Vertex_index vertices[3];
    for (std::size_t i = 0; i < 3; ++i)
      vertices[i] = mesh.add_vertex({triangle[i].x, triangle[i].y, triangle[i].z});
    mesh.add_face(vertices[0], vertices[1], vertices[2]);
  }
  return mesh;
}

}  // namespace

double cgal_hausdorff(std::span<const Corners> from, std::span<const Corners> to, double error) {
  return CGAL::Polygon_mesh_processing::bounded_error_Hausdorff_distance<CGAL::Sequential_tag>(
      mesh_of(from), mesh_of(to), error);
}

}  // namespace planetree::oracle
