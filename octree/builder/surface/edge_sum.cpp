#include "octree/builder/surface/edge_sum.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>

#include "octree/geometry/strict_math.h"
#include "storage/file/checksum.h"

namespace planetree::octree {
namespace {

bool precedes(const Point& a, const Point& b) {
  return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
}

}  // namespace

void EdgeSum::add(const Triangle& triangle) {
  for (unsigned corner = 0; corner < 3; ++corner)
    add_edge(triangle[corner], triangle[(corner + 1) % 3]);
}

void EdgeSum::add(const EdgeSum& other) {
  low_ += other.low_;
  high_ += other.high_ + (low_ < other.low_);
}

void EdgeSum::add_edge(const Point& from, const Point& to) {
  if (from == to) return;
  const bool forward = precedes(from, to);
  const std::array<Point, 2> ends{forward ? from : to, forward ? to : from};
  const storage::Hash128 hash = storage::hash128(std::as_bytes(std::span(ends)));
  EdgeSum edge;
  // To subtract, the complement to 2^128 is added.
  edge.low_ = forward ? hash.low : ~hash.low + 1;
  edge.high_ = forward ? hash.high : ~hash.high + (hash.low == 0);
  add(edge);
}

}  // namespace planetree::octree
