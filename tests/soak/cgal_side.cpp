#include "tests/soak/cgal_side.h"

#include <array>
#include <map>
#include <optional>
#include <vector>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Side_of_triangle_mesh.h>
#include <CGAL/Surface_mesh.h>

namespace planetree::oracle {
namespace {

namespace pmp = CGAL::Polygon_mesh_processing;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using SurfaceMesh = CGAL::Surface_mesh<Kernel::Point_3>;

}  // namespace

class CgalSide::Mesh {
 public:
  explicit Mesh(std::span<const Corners> triangles) {
    std::vector<Kernel::Point_3> points;
    std::vector<std::vector<std::size_t>> faces;
    std::map<std::array<double, 3>, std::size_t> numbers;
    for (const Corners& triangle : triangles) {
      std::vector<std::size_t> face;
      for (const Vec3& p : triangle) {
        const auto [found, is_new] = numbers.try_emplace({p.x, p.y, p.z}, points.size());
        if (is_new) points.emplace_back(p.x, p.y, p.z);
        face.push_back(found->second);
      }
      if (face[0] != face[1] && face[1] != face[2] && face[2] != face[0])
        faces.push_back(std::move(face));
    }
    pmp::orient_polygon_soup(points, faces);  // splits vertices where surfaces touch
    if (!pmp::is_polygon_soup_a_polygon_mesh(faces)) return;
    pmp::polygon_soup_to_polygon_mesh(points, faces, mesh_);
    if (CGAL::is_closed(mesh_)) side_.emplace(mesh_);
  }

  bool usable() const { return side_.has_value(); }
  Side side(const Vec3& query) const {
    switch ((*side_)(Kernel::Point_3(query.x, query.y, query.z))) {
      case CGAL::ON_BOUNDED_SIDE:
        return Side::kInside;
      case CGAL::ON_UNBOUNDED_SIDE:
        return Side::kOutside;
      case CGAL::ON_BOUNDARY:
        break;
    }
    return Side::kOnSurface;
  }

 private:
  SurfaceMesh mesh_;
  std::optional<CGAL::Side_of_triangle_mesh<SurfaceMesh, Kernel>> side_;
};

CgalSide::CgalSide(std::span<const Corners> triangles) : mesh_(std::make_unique<Mesh>(triangles)) {}
CgalSide::~CgalSide() = default;

bool CgalSide::usable() const { return mesh_->usable(); }
Side CgalSide::side(const Vec3& query) const { return mesh_->side(query); }

}  // namespace planetree::oracle
