#include "tests/oracle/cgal_oracle.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>

namespace planetree::oracle {
namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Point = Kernel::Point_3;
using Triangle = Kernel::Triangle_3;
using Triangles = std::vector<Triangle>;
using Primitive = CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>;
using Traits = CGAL::AABB_traits<Kernel, Primitive>;

// Below this squared sine a projection in double loses too many digits.
constexpr double kThinSine2 = 1e-8;

Point point(const Vec3& p) { return {p.x, p.y, p.z}; }

bool thin(const Corners& t) {
  const auto ab = point(t[1]) - point(t[0]), ac = point(t[2]) - point(t[0]);
  const auto bc = point(t[2]) - point(t[1]);
  const double area2 = CGAL::cross_product(ab, ac).squared_length();
  const double longest2 = std::max({ab.squared_length(), ac.squared_length(), bc.squared_length()});
  return !(area2 > kThinSine2 * longest2 * longest2);
}

}  // namespace

class CgalOracle::Tree {
 public:
  explicit Tree(std::span<const Corners> all) {
    for (const Corners& triangle : all) {
      if (thin(triangle)) {
        thin_.push_back(triangle);
      } else {
        triangles_.emplace_back(point(triangle[0]), point(triangle[1]), point(triangle[2]));
        corners_.push_back(&triangle);
      }
    }
    tree_.insert(triangles_.begin(), triangles_.end());
    tree_.accelerate_distance_queries();
  }

  [[nodiscard]] long double distance(const Vec3& query) const {
    long double best = extended_distance(query, thin_);
    if (triangles_.empty()) return best;
    const auto found = tree_.closest_point_and_primitive(point(query)).second;
    return std::min(
        best,
        extended_distance(query, *corners_[static_cast<std::size_t>(found - triangles_.begin())]));
  }
  [[nodiscard]] std::size_t thin_count() const { return thin_.size(); }

 private:
  Triangles triangles_;
  std::vector<const Corners*> corners_;
  std::vector<Corners> thin_;
  CGAL::AABB_tree<Traits> tree_;
};

CgalOracle::CgalOracle(std::span<const Corners> triangles)
    : tree_(std::make_unique<Tree>(triangles)) {}
CgalOracle::~CgalOracle() = default;
long double CgalOracle::distance(const Vec3& query) const { return tree_->distance(query); }
std::size_t CgalOracle::thin_count() const { return tree_->thin_count(); }

}  // namespace planetree::oracle
