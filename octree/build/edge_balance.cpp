#include "octree/build/edge_balance.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>
#include <tbb/parallel_sort.h>

#include "octree/octcode.h"
#include "octree/strict_math.h"
#include "storage/checksum.h"

namespace planetree::octree {
namespace {

constexpr std::size_t kTrianglesPerTask = 4096;
constexpr std::size_t kKeysPerTask = 16384;
/// Cells along an axis of the model frame's unit: 16 over a model.
constexpr double kCellsPerUnit = 8;

struct Edge {
  Point from, to;
};

bool precedes(const Point& a, const Point& b) {
  return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
}

/// Ends of an edge in the same order whichever way it runs.
using Ends = std::array<Point, 2>;

bool precedes(const Ends& a, const Ends& b) {
  return precedes(a[0], b[0]) || (a[0] == b[0] && precedes(a[1], b[1]));
}

Ends ends_of(const Edge& edge) {
  const bool forward = precedes(edge.from, edge.to);
  return {forward ? edge.from : edge.to, forward ? edge.to : edge.from};
}

/// An edge of a triangle in one word, so that equal edges sort together and near
/// others: from the highest bit on
///
///   12  Morton code of the cell that its middle is in
///   18  hash of its ends
///   34  place: 4 * triangle position + the corner it starts at
///
/// Without the cells the corners that a task looks at would be anywhere in
/// memory, which takes thrice the time. Different edges may share the first 30.
class EdgeKey {
 public:
  EdgeKey() = default;  ///< of an edge without length: after all others
  EdgeKey(std::uint64_t cell, std::uint64_t hash, std::uint64_t place)
      : bits_(cell << 52 | (hash & kHashMask) | place) {}

  std::uint64_t group() const { return bits_ & ~kPlaceMask; }
  std::uint64_t place() const { return bits_ & kPlaceMask; }
  bool has_length() const { return bits_ != ~std::uint64_t{0}; }
  friend bool operator<(EdgeKey a, EdgeKey b) { return a.bits_ < b.bits_; }

 private:
  static constexpr std::uint64_t kPlaceMask = (std::uint64_t{1} << 34) - 1;
  static constexpr std::uint64_t kHashMask = (std::uint64_t{1} << 52) - 1 - kPlaceMask;
  std::uint64_t bits_ = ~std::uint64_t{0};
};

/// Open edges of some of the keys, the first by place; joined in any order they
/// come to the same.
class OpenEdges {
 public:
  void note(std::uint64_t place, const OpenEdge& edge) {
    ++balance_.open_edges;
    list(place, edge);
  }

  void join(const OpenEdges& other) {
    balance_.open_edges += other.balance_.open_edges;
    for (std::size_t i = 0; i < EdgeBalance::kListed; ++i)
      list(other.places_[i], other.balance_.first[i]);
  }

  const EdgeBalance& balance() const { return balance_; }

 private:
  void list(std::uint64_t place, const OpenEdge& edge) {
    for (std::size_t i = 0; i < EdgeBalance::kListed; ++i)
      if (place < places_[i]) {
        std::shift_right(places_.begin() + i, places_.end(), 1);
        std::shift_right(balance_.first.begin() + i, balance_.first.end(), 1);
        places_[i] = place;
        balance_.first[i] = edge;
        return;
      }
  }

  static constexpr std::uint64_t kNowhere = ~std::uint64_t{0};

  EdgeBalance balance_;
  std::array<std::uint64_t, EdgeBalance::kListed> places_{kNowhere, kNowhere, kNowhere};
};

class Balance {
 public:
  explicit Balance(const MeshStore& mesh)
      : mesh_(mesh), lower_(mesh.lower()), keys_(std::size_t{3} * mesh.size()) {}

  EdgeBalance run() {
    collect();
    tbb::parallel_sort(keys_.begin(), keys_.end());
    while (!keys_.empty() && !keys_.back().has_length()) keys_.pop_back();
    using Range = tbb::blocked_range<std::size_t>;
    const auto balance_range = [this](const Range& range, OpenEdges found) {
      balance(range.begin(), range.end(), found);
      return found;
    };
    const auto join = [](OpenEdges left, const OpenEdges& right) {
      left.join(right);
      return left;
    };
    return tbb::parallel_reduce(Range(0, keys_.size(), kKeysPerTask), OpenEdges(), balance_range,
                                join)
        .balance();
  }

 private:
  Edge edge(EdgeKey key) const {
    const std::uint64_t corner = key.place() % 4;
    const Triangle triangle = mesh_.corners(static_cast<std::uint32_t>(key.place() / 4));
    return {triangle[corner], triangle[(corner + 1) % 3]};
  }

  EdgeKey key_of(const Edge& edge, std::uint64_t place) const {
    const Ends ends = ends_of(edge);
    const Point middle = ((ends[0] + ends[1]) * 0.5 - lower_) * kCellsPerUnit;
    const auto cell = [&](Eigen::Index axis) { return static_cast<std::uint32_t>(middle[axis]); };
    return {morton_code(cell(0), cell(1), cell(2)), storage::hash64(std::as_bytes(std::span(ends))),
            place};
  }

  void collect() {
    using Range = tbb::blocked_range<std::uint32_t>;
    tbb::parallel_for(Range(0, mesh_.size(), kTrianglesPerTask), [&](const Range& range) {
      for (std::uint32_t position = range.begin(); position < range.end(); ++position) {
        const Triangle triangle = mesh_.corners(position);
        for (std::size_t corner = 0; corner < 3; ++corner) {
          const Edge edge{triangle[corner], triangle[(corner + 1) % 3]};
          if (edge.from != edge.to)
            keys_[std::size_t{3} * position + corner] =
                key_of(edge, std::uint64_t{4} * position + corner);
        }
      }
    });
  }

  // Position of the first key from `at` on that is of another group, up to `end`.
  std::size_t skip_group(std::size_t at, std::size_t end) const {
    const std::uint64_t group = keys_[at].group();
    while (at < end && keys_[at].group() == group) ++at;
    return at;
  }

  // Groups belong to the range that they begin in.
  void balance(std::size_t begin, std::size_t end, OpenEdges& found) const {
    if (begin > 0 && keys_[begin].group() == keys_[begin - 1].group())
      begin = skip_group(begin, end);
    while (begin < end) {
      const std::size_t next = skip_group(begin, keys_.size());
      const auto group = std::span(keys_).subspan(begin, next - begin);
      if (!balance_edge(group, found)) balance_sorted({group.begin(), group.end()}, found);
      begin = next;
    }
  }

  // Whether all keys, which are in order of place, are of one edge; notes it then.
  bool balance_edge(std::span<const EdgeKey> keys, OpenEdges& found) const {
    const std::uint64_t place = keys.front().place();
    const Edge first = edge(keys.front());
    OpenEdge one{mesh_.index(static_cast<std::uint32_t>(place / 4)), first.from, first.to, 1, 0};
    for (const EdgeKey key : keys.subspan(1)) {
      const Edge other = edge(key);
      if (other.from == first.from && other.to == first.to)
        ++one.along;
      else if (other.from == first.to && other.to == first.from)
        ++one.against;
      else
        return false;
    }
    if (one.along != one.against) found.note(place, one);
    return true;
  }

  // Of several edges in one group.
  void balance_sorted(std::vector<EdgeKey> keys, OpenEdges& found) const {
    std::sort(keys.begin(), keys.end(), [this](EdgeKey a, EdgeKey b) {
      const Ends left = ends_of(edge(a)), right = ends_of(edge(b));
      return precedes(left, right) || (left == right && a < b);
    });
    for (auto begin = keys.begin(); begin != keys.end();) {
      const Ends ends = ends_of(edge(*begin));
      const auto end =
          std::find_if(begin, keys.end(), [&](EdgeKey key) { return ends_of(edge(key)) != ends; });
      balance_edge({begin, end}, found);
      begin = end;
    }
  }

  const MeshStore& mesh_;
  const Point lower_;
  std::vector<EdgeKey> keys_;
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
