#include "tests/oracle/queries/triangle_part.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include <boost/function_output_iterator.hpp>
#include <boost/geometry/algorithms/comparable_distance.hpp>
#include <boost/geometry/geometries/box.hpp>
#include <boost/geometry/geometries/point.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <boost/geometry/strategies/strategies.hpp>

namespace planetree::oracle {
namespace {

namespace geometry = boost::geometry;
namespace tree = boost::geometry::index;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

using BoxCorner = geometry::model::point<double, 3, geometry::cs::cartesian>;
using Box = geometry::model::box<BoxCorner>;
using Entry = std::pair<Box, std::uint32_t>;

Box box_of(const Corners& t) {
  const auto [x0, x1] = std::minmax({t[0].x, t[1].x, t[2].x});
  const auto [y0, y1] = std::minmax({t[0].y, t[1].y, t[2].y});
  const auto [z0, z1] = std::minmax({t[0].z, t[1].z, t[2].z});
  return {BoxCorner(x0, y0, z0), BoxCorner(x1, y1, z1)};
}

std::vector<Entry> entries_of(std::span<const Corners> triangles) {
  std::vector<Entry> entries;
  entries.reserve(triangles.size());
  for (std::uint32_t index = 0; index < triangles.size(); ++index)
    entries.emplace_back(box_of(triangles[index]), index);
  return entries;
}

// Output iterator for what an R-tree finds.
auto indices(std::vector<std::uint32_t>& found) {
  return boost::make_function_output_iterator(
      [&found](const Entry& entry) { found.push_back(entry.second); });
}

// A ball made larger by a few roundings: its box and its squared radius.
struct WideBall {
  WideBall(const Vec3& at, double reach) : centre(at.x, at.y, at.z) {
    const double wide = reach * (1 + 0x1p-48);
    const auto below = [wide](double c) { return std::nextafter(c - wide, -kInfinity); };
    const auto above = [wide](double c) { return std::nextafter(c + wide, kInfinity); };
    box = {BoxCorner(below(at.x), below(at.y), below(at.z)),
           BoxCorner(above(at.x), above(at.y), above(at.z))};
    squared = wide * wide + std::numeric_limits<double>::min();
  }
  bool may_meet(const Box& other) const {
    return geometry::comparable_distance(centre, other) <= squared;
  }

  BoxCorner centre;
  Box box;
  double squared;
};

}  // namespace

class TrianglePart::Tree {
 public:
  explicit Tree(std::span<const Corners> triangles)
      : boxes_(entries_of(triangles)), bounds_(boxes_.bounds()) {}

  void find_near(const Vec3& query, double reach, std::vector<std::uint32_t>& found) const {
    const WideBall ball(query, reach);
    if (!ball.may_meet(bounds_)) return;
    // A ball that meets the bounds rarely meets a triangle's box. The first search is short and few
    // balls pass it; the second is guided by the ball's box alone.
    const auto nearest = boxes_.qbegin(tree::nearest(ball.centre, 1));
    if (!ball.may_meet(nearest->first)) return;
    const auto may_meet = [&ball](const Entry& entry) { return ball.may_meet(entry.first); };
    boxes_.query(tree::intersects(ball.box) && tree::satisfies(may_meet), indices(found));
  }

  void find_ahead(const Vec3& query, std::vector<std::uint32_t>& found) const {
    const Box ray(BoxCorner(query.x, query.y, query.z), BoxCorner(kInfinity, query.y, query.z));
    if (geometry::intersects(ray, bounds_)) boxes_.query(tree::intersects(ray), indices(found));
  }

 private:
  tree::rtree<Entry, tree::rstar<16>> boxes_;
  Box bounds_;
};

TrianglePart::TrianglePart(std::span<const Corners> triangles)
    : tree_(std::make_unique<Tree>(triangles)) {}
TrianglePart::~TrianglePart() = default;
TrianglePart::TrianglePart(TrianglePart&&) noexcept = default;

void TrianglePart::find_near(const Vec3& query, double reach,
                             std::vector<std::uint32_t>& found) const {
  tree_->find_near(query, reach, found);
}
void TrianglePart::find_ahead(const Vec3& query, std::vector<std::uint32_t>& found) const {
  tree_->find_ahead(query, found);
}

}  // namespace planetree::oracle
