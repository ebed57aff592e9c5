#include "tools/edge_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "octree/strict_math.h"
#include "query/scale.h"
#include "storage/checksum.h"

namespace planetree::tools {
namespace {

using octree::Point;

bool precedes(const Point& a, const Point& b) {
  return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
}

}  // namespace

EdgeCheck::EdgeCheck(const storage::ModelRecord& model) : model_(model) {
  const query::Scale scale(model.scale_exponent);
  for (std::size_t i = 0; i < listed_.size(); ++i) {
    const storage::OpenEdge& edge = model.open_edge[i];
    listed_[i].from = scale.in(Vec3{edge.from[0], edge.from[1], edge.from[2]});
    listed_[i].to = scale.in(Vec3{edge.to[0], edge.to[1], edge.to[2]});
  }
}

void EdgeCheck::add(const octree::Triangle& triangle) {
  for (unsigned corner = 0; corner < 3; ++corner)
    add_edge(triangle[corner], triangle[(corner + 1) % 3]);
}

void EdgeCheck::add_edge(const Point& from, const Point& to) {
  if (from == to) return;
  const bool forward = precedes(from, to);
  const std::array<Point, 2> ends{forward ? from : to, forward ? to : from};
  const storage::Hash128 hash = storage::hash128(std::as_bytes(std::span(ends)));
  const std::uint64_t low = sum_[0];
  if (forward) {
    sum_[0] += hash.low;
    sum_[1] += hash.high + (sum_[0] < low);
  } else {
    sum_[0] -= hash.low;
    sum_[1] -= hash.high + (sum_[0] > low);
  }
  for (Counted& edge : listed_) {
    edge.along += edge.from == from && edge.to == to;
    edge.against += edge.from == to && edge.to == from;
  }
}

std::optional<std::string> EdgeCheck::finding() const {
  const bool watertight = sum_[0] == 0 && sum_[1] == 0;
  if (watertight != (model_.open_edge_count == 0))
    return watertight ? "the header says that edges are open and none is"
                      : "the header says that the surface is watertight and it is not";
  for (std::size_t i = 0; i < std::min<std::uint64_t>(model_.open_edge_count, listed_.size()); ++i)
    if (listed_[i].along != model_.open_edge[i].along ||
        listed_[i].against != model_.open_edge[i].against)
      return fmt::format("{} triangles run along open edge {} and {} against it, not {} and {}",
                         listed_[i].along, i, listed_[i].against, model_.open_edge[i].along,
                         model_.open_edge[i].against);
  return std::nullopt;
}

}  // namespace planetree::tools
