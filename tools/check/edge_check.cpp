#include "tools/check/edge_check.h"

#include <fmt/format.h>

#include <algorithm>

#include "octree/geometry/strict_math.h"
#include "query/file/scale.h"

namespace planetree::tools {
namespace {

using octree::Point;

}  // namespace

EdgeCheck::EdgeCheck(const storage::ModelRecord& model) : model_(model) {
  const query::Scale scale(model.scale_exponent);
  for (std::size_t i = 0; i < listed_.size(); ++i) {
    const storage::UnbalancedEdge& edge = model.unbalanced_edge[i];
    listed_[i].from = scale.in(Vec3{edge.from[0], edge.from[1], edge.from[2]});
    listed_[i].to = scale.in(Vec3{edge.to[0], edge.to[1], edge.to[2]});
  }
}

void EdgeCheck::add(const octree::Triangle& triangle) {
  edges_.add(triangle);
  for (unsigned corner = 0; corner < 3; ++corner)
    count(triangle[corner], triangle[(corner + 1) % 3]);
}

void EdgeCheck::count(const Point& from, const Point& to) {
  if (from == to) return;
  for (ListedEdge& edge : listed_) {
    edge.along += edge.from == from && edge.to == to;
    edge.against += edge.from == to && edge.to == from;
  }
}

std::optional<std::string> EdgeCheck::finding() const {
  const bool watertight = edges_.is_watertight();
  if (watertight != (model_.unbalanced_edge_count == 0))
    return watertight ? "the header states unbalanced edges, but there are none"
                      : "the header states that the surface is watertight, but it is not";
  for (std::size_t i = 0; i < std::min<std::uint64_t>(model_.unbalanced_edge_count, listed_.size());
       ++i)
    if (listed_[i].along != model_.unbalanced_edge[i].along ||
        listed_[i].against != model_.unbalanced_edge[i].against)
      return fmt::format(
          "{} triangles run along unbalanced edge {} and {} against it, not {} and {}",
          listed_[i].along, i, listed_[i].against, model_.unbalanced_edge[i].along,
          model_.unbalanced_edge[i].against);
  return std::nullopt;
}

}  // namespace planetree::tools
