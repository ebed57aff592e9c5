#include "tools/check/edge_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <span>

#include "octree/geometry/strict_math.h"
#include "query/file/scale.h"
#include "storage/file/checksum.h"

namespace planetree::tools {

using octree::Point;

EdgeCheck::EdgeCheck(const storage::ModelRecord& model)
    : model_(model), are_counted_(model.triangle_count <= kMaxCounted) {
  const query::Scale scale(model.scale_exponent);
  listed_.resize(
      std::min<std::uint64_t>(model.unbalanced_edge_count, std::size(model.unbalanced_edge)));
  for (std::size_t i = 0; i < listed_.size(); ++i) {
    const storage::UnbalancedEdge& edge = model.unbalanced_edge[i];
    listed_[i].from = scale.in(Vec3{edge.from[0], edge.from[1], edge.from[2]});
    listed_[i].to = scale.in(Vec3{edge.to[0], edge.to[1], edge.to[2]});
    const Ends ends = ends_of(listed_[i].from, listed_[i].to);
    greatest_ = i == 0 ? ends : std::max(greatest_, ends);
  }
}

EdgeCheck::Ends EdgeCheck::ends_of(const Point& a, const Point& b) {
  const Ends forward{a.x(), a.y(), a.z(), b.x(), b.y(), b.z()};
  const Ends back{b.x(), b.y(), b.z(), a.x(), a.y(), a.z()};
  return std::min(forward, back);
}

void EdgeCheck::add(const octree::Triangle& triangle, std::uint64_t index) {
  edges_.add(triangle);
  for (unsigned corner = 0; corner < 3; ++corner)
    count(triangle[corner], triangle[(corner + 1) % 3], {index, corner, false});
}

void EdgeCheck::count(const Point& from, const Point& to, EdgeUse use) {
  if (from == to) return;
  const Ends ends = ends_of(from, to);
  if (are_counted_) {
    const bool is_forward = std::equal(from.begin(), from.end(), ends.begin());
    ways_.emplace_back(storage::hash64(std::as_bytes(std::span(ends))), is_forward ? 1 : -1);
  }
  bool is_listed = false;
  for (ListedEdge& edge : listed_) {
    use.is_along = edge.from == from && edge.to == to;
    if (!use.is_along && !(edge.from == to && edge.to == from)) continue;
    is_listed = true;
    ++(use.is_along ? edge.along : edge.against);
    edge.first = std::min(edge.first, use);
  }
  const bool is_full = listed_.size() == std::size(model_.unbalanced_edge);
  if (!is_listed && (!is_full || ends < greatest_)) lesser_.add_edge(from, to);
}

std::uint64_t EdgeCheck::count_unbalanced() {
  std::sort(ways_.begin(), ways_.end());
  std::uint64_t found = 0;
  for (std::size_t i = 0; i < ways_.size();) {
    const std::uint64_t hash = ways_[i].first;
    std::int64_t net = 0;
    for (; i < ways_.size() && ways_[i].first == hash; ++i) net += ways_[i].second;
    found += net != 0;
  }
  return found;
}

std::optional<std::string> EdgeCheck::finding_of(std::size_t i) const {
  const ListedEdge& edge = listed_[i];
  const storage::UnbalancedEdge& stated = model_.unbalanced_edge[i];
  if (edge.along != stated.along || edge.against != stated.against)
    return fmt::format("{} triangles run along unbalanced edge {} and {} against it, not {} and {}",
                       edge.along, i, edge.against, stated.along, stated.against);
  if (edge.first.triangle != stated.triangle || !edge.first.is_along)
    return fmt::format("triangle {} is not the least one with unbalanced edge {}, or runs back",
                       stated.triangle, i);
  if (i > 0 && !(listed_[i - 1].first < edge.first))
    return std::string("the listed unbalanced edges are not in the order of their triangles");
  return std::nullopt;
}

std::optional<std::string> EdgeCheck::finding() {
  const bool watertight = edges_.is_watertight();
  if (watertight != (model_.unbalanced_edge_count == 0))
    return watertight ? "the header states unbalanced edges, but there are none"
                      : "the header states that the surface is watertight, but it is not";
  for (std::size_t i = 0; i < listed_.size(); ++i)
    if (auto found = finding_of(i)) return found;
  if (!lesser_.is_watertight())
    return "the header does not list the least of the unbalanced edges, or not all of them";
  if (!are_counted_) return std::nullopt;
  const std::uint64_t count = count_unbalanced();
  if (count == model_.unbalanced_edge_count) return std::nullopt;
  return fmt::format("the header states {} unbalanced edges, but there are {}",
                     model_.unbalanced_edge_count, count);
}

}  // namespace planetree::tools
