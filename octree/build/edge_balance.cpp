#include "octree/build/edge_balance.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include <tbb/parallel_sort.h>

#include "octree/strict_math.h"
#include "storage/checksum.h"

namespace planetree::octree {
namespace {

/// Edges are looked at in this many parts, one after the other, so that a part
/// takes a fraction of the memory.
constexpr unsigned kPartBits = 2;

struct Edge {
  Point from, to;
};

bool precedes(const Point& a, const Point& b) {
  return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
}

/// An edge of a triangle: a hash of its ends, whichever way it runs, and where
/// it is. Equal edges have equal hashes.
struct EdgeKey {
  std::uint64_t hash;
  std::uint64_t place;  ///< 4 * triangle position + corner it starts at

  friend bool operator<(const EdgeKey& a, const EdgeKey& b) {
    return a.hash < b.hash || (a.hash == b.hash && a.place < b.place);
  }
};

std::uint64_t hash_of(const Edge& edge) {
  const bool forward = precedes(edge.from, edge.to);
  const std::array<Point, 2> ends{forward ? edge.from : edge.to, forward ? edge.to : edge.from};
  return storage::hash64(std::as_bytes(std::span(ends)));
}

class Balance {
 public:
  explicit Balance(const MeshStore& mesh) : mesh_(mesh) {}

  EdgeBalance run() {
    for (std::uint64_t part = 0; part < std::uint64_t{1} << kPartBits; ++part) {
      collect(part);
      tbb::parallel_sort(keys_.begin(), keys_.end());
      for (auto begin = keys_.begin(); begin != keys_.end();) {
        const auto end = std::find_if(begin, keys_.end(),
                                      [&](const EdgeKey& key) { return key.hash != begin->hash; });
        balance({begin, end});
        begin = end;
      }
    }
    return result_;
  }

 private:
  Edge edge(std::uint64_t place) const {
    const Triangle triangle = mesh_.corners(static_cast<std::uint32_t>(place / 4));
    return {triangle[place % 4], triangle[(place % 4 + 1) % 3]};
  }

  // The part's edges, those without length left out.
  void collect(std::uint64_t part) {
    keys_.clear();
    for (std::uint32_t position = 0; position < mesh_.size(); ++position) {
      const Triangle triangle = mesh_.corners(position);
      for (std::uint64_t corner = 0; corner < 3; ++corner) {
        const Edge edge{triangle[corner], triangle[(corner + 1) % 3]};
        if (edge.from == edge.to) continue;
        const std::uint64_t hash = hash_of(edge);
        if (hash >> (64 - kPartBits) == part)
          keys_.push_back({hash, std::uint64_t{4} * position + corner});
      }
    }
  }

  // Balances edges of one hash: of one edge but for a rare accident, when they
  // are taken one edge after the other.
  void balance(std::span<const EdgeKey> keys) {
    std::vector<EdgeKey> others;
    const std::uint64_t place = keys.front().place;
    const Edge first = edge(place);
    OpenEdge found{mesh_.index(static_cast<std::uint32_t>(place / 4)), first.from, first.to};
    for (const EdgeKey& key : keys) {
      const Edge other = edge(key.place);
      if (other.from == first.from && other.to == first.to)
        ++found.along;
      else if (other.from == first.to && other.to == first.from)
        ++found.against;
      else
        others.push_back(key);
    }
    if (found.along != found.against) note(place, found);
    if (!others.empty()) balance(others);
  }

  void note(std::uint64_t place, const OpenEdge& edge) {
    ++result_.open_edges;
    for (std::size_t i = 0; i < EdgeBalance::kListed; ++i)
      if (place < places_[i]) {
        std::shift_right(places_.begin() + i, places_.end(), 1);
        std::shift_right(result_.first.begin() + i, result_.first.end(), 1);
        places_[i] = place;
        result_.first[i] = edge;
        return;
      }
  }

  static constexpr std::uint64_t kNowhere = ~std::uint64_t{0};

  const MeshStore& mesh_;
  std::vector<EdgeKey> keys_;
  EdgeBalance result_;
  std::array<std::uint64_t, EdgeBalance::kListed> places_{kNowhere, kNowhere, kNowhere};
};

}  // namespace

void EdgeBalance::describe(int scale_exponent, storage::ModelRecord& model) const {
  model.open_edge_count = open_edges;
  for (std::size_t i = 0; i < std::min<std::uint64_t>(open_edges, kListed); ++i) {
    storage::OpenEdge& edge = model.open_edge[i];
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      edge.from[axis] = std::ldexp(first[i].from[axis], -scale_exponent);
      edge.to[axis] = std::ldexp(first[i].to[axis], -scale_exponent);
    }
    edge.triangle = first[i].triangle;
    edge.along = first[i].along;
    edge.against = first[i].against;
  }
}

EdgeBalance balance_edges(const MeshStore& mesh) { return Balance(mesh).run(); }

}  // namespace planetree::octree
