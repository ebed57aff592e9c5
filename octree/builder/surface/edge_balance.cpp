#include "octree/builder/surface/edge_balance.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <span>
#include <utility>

#include "octree/builder/job/parallel.h"
#include "octree/geometry/strict_math.h"
#include "storage/file/checksum.h"

namespace planetree::octree {
namespace {

/// The ends of an edge, in the same order whatever the direction of the face.
using Ends = std::array<double, 6>;

struct HalfEdge {
  Ends ends{};
  int way = 0;  // 1: from the lesser end to the greater; -1: back; 0: without length
};

HalfEdge half_edge(const Triangle& triangle, std::size_t corner) {
  const Point &from = triangle[corner], &to = triangle[(corner + 1) % 3];
  if (from == to) return {};
  const bool forward = std::lexicographical_compare(from.begin(), from.end(), to.begin(), to.end());
  const Point &a = forward ? from : to, &b = forward ? to : from;
  return {{a.x(), a.y(), a.z(), b.x(), b.y(), b.z()}, forward ? 1 : -1};
}

std::uint64_t hash_of(const Ends& ends) { return storage::hash64(std::as_bytes(std::span(ends))); }

/// An edge that is not balanced within a chunk.
struct LeftOver {
  storage::SpillKey key;  // hash of the ends
  Ends ends{};
  std::int64_t net = 0;  // faces that run forward minus faces that run back
};

static_assert(sizeof(LeftOver) == EdgeCensus::kEdgeBytes);

/// The edges of a chunk, in a hash table.
class EdgeTable {
 public:
  explicit EdgeTable(const Triangles& chunk)
      : chunk_(chunk), entries_(std::bit_ceil(std::size_t{3} * chunk.size() + 1)) {
    std::array<Pending, 3 * std::size_t{kAtOnce}> pending;
    for (std::uint32_t first = 0; first < chunk.size(); first += kAtOnce) {
      std::size_t count = 0;
      const std::uint32_t end = std::min(first + kAtOnce, chunk.size());
      for (std::uint32_t i = first; i < end; ++i) {
        const Triangle triangle = chunk.corners(i);
        for (unsigned corner = 0; corner < 3; ++corner) {
          const HalfEdge edge = half_edge(triangle, corner);
          if (edge.way == 0) continue;
          pending[count] = {edge, hash_of(edge.ends), 4 * i + corner};
          __builtin_prefetch(&entry_at(pending[count].hash));
          ++count;
        }
      }
      for (std::size_t k = 0; k < count; ++k) add(pending[k]);
    }
  }

  // The edges that are not balanced, as records in the order of their keys. All edges of a soup are
  // left over, so that only as much memory is taken as the records need.
  std::vector<std::byte> left_over() const {
    std::vector<std::pair<std::uint64_t, std::uint32_t>> order;  // hash, position
    order.reserve(static_cast<std::size_t>(std::count_if(
        entries_.begin(), entries_.end(), [](const Entry& entry) { return entry.net != 0; })));
    for (std::uint32_t at = 0; at < entries_.size(); ++at)
      if (entries_[at].net != 0) order.emplace_back(hash_of(ends_of(entries_[at])), at);
    std::sort(order.begin(), order.end());
    std::vector<std::byte> records(order.size() * sizeof(LeftOver));
    std::byte* to = records.data();
    for (const auto& [hash, at] : order) {
      const LeftOver edge{{hash, 0}, ends_of(entries_[at]), entries_[at].net};
      std::memcpy(to, &edge, sizeof edge);
      to += sizeof edge;
    }
    return records;
  }

 private:
  // Small, because accesses are scattered over the whole table.
  struct Entry {
    std::uint32_t index = kNone;  // 4 * triangle + corner of the first face that has the edge
    std::int32_t net = 0;
  };
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};
  struct Pending {
    HalfEdge edge;
    std::uint64_t hash;
    std::uint32_t index;
  };
  // Triangles whose entries are prefetched before the first of them is used.
  static constexpr std::uint32_t kAtOnce = 16;

  Entry& entry_at(std::uint64_t hash) { return entries_[hash & (entries_.size() - 1)]; }

  Ends ends_of(const Entry& entry) const {
    return half_edge(chunk_.corners(entry.index / 4), entry.index % 4).ends;
  }

  void add(const Pending& pending) {
    for (std::uint64_t hash = pending.hash;; ++hash) {
      Entry& entry = entry_at(hash);
      if (entry.index == kNone)
        entry.index = pending.index;
      else if (ends_of(entry) != pending.edge.ends)
        continue;
      entry.net += pending.edge.way;
      return;
    }
  }

  const Triangles& chunk_;
  std::vector<Entry> entries_;
};

/// Unbalanced edges with hashes in some range, and those with the least ends among them.
struct UnbalancedEnds {
  std::vector<std::pair<Ends, std::int64_t>> all;  // with the net number of faces
  std::uint64_t count = 0;
  std::vector<Ends> least;

  void note(const Ends& ends, std::int64_t net) {
    ++count;
    all.emplace_back(ends, net);
    list(ends);
  }
  void join(const UnbalancedEnds& other) {
    count += other.count;
    for (const Ends& ends : other.least) list(ends);
  }
  void list(const Ends& ends) {
    least.insert(std::upper_bound(least.begin(), least.end(), ends), ends);
    if (least.size() > EdgeBalance::kListed) least.pop_back();
  }
};

UnbalancedEnds unbalanced_ends(std::vector<LeftOver> edges) {
  std::sort(edges.begin(), edges.end(),
            [](const LeftOver& a, const LeftOver& b) { return a.ends < b.ends; });
  UnbalancedEnds unbalanced;
  for (std::size_t i = 0; i < edges.size();) {
    const Ends& ends = edges[i].ends;
    std::int64_t net = 0;
    for (; i < edges.size() && edges[i].ends == ends; ++i) net += edges[i].net;
    if (net != 0) unbalanced.note(edges[i - 1].ends, net);
  }
  return unbalanced;
}

/// Approximate number of left-over edges that are balanced at a time.
constexpr std::uint64_t kEdgesAtOnce = 1 << 17;

}  // namespace

EdgeCensus::EdgeCensus(std::uint64_t held_bytes, storage::SpillFile& file)
    : left_over_(sizeof(LeftOver), held_bytes, file) {}

Result<void> EdgeCensus::add(const Triangles& chunk) {
  const auto added = left_over_.add(EdgeTable(chunk).left_over());
  if (!added) return added.error();
  return {};
}

Result<EdgeBalance> EdgeCensus::balance(CapChain* boundary) {
  // The hashes are divided into equal ranges; their number is a power of two.
  const std::uint64_t shares = std::bit_ceil(left_over_.size() / kEdgesAtOnce + 1);
  const auto cut = [&](std::uint64_t share) -> Result<storage::SpillRuns::Cut> {
    if (share == shares) return left_over_.end();
    return left_over_.cut({share * (~std::uint64_t{0} / shares + 1), 0});
  };
  std::mutex mutex;
  UnbalancedEnds unbalanced;
  const auto balanced = for_each_in_parallel(shares, [&](std::size_t share) -> Result<void> {
    const auto from = cut(share), to = cut(share + 1);
    if (!from) return from.error();
    if (!to) return to.error();
    const auto records = left_over_.read(*from, *to);
    if (!records) return records.error();
    std::vector<LeftOver> edges(records->size() / sizeof(LeftOver));
    if (!edges.empty()) std::memcpy(edges.data(), records->data(), records->size());
    const UnbalancedEnds some = unbalanced_ends(std::move(edges));
    const std::lock_guard lock(mutex);
    unbalanced.join(some);
    if (!boundary) return {};
    for (const auto& [e, net] : some.all)
      if (const auto added = boundary->add({e[0], e[1], e[2]}, {e[3], e[4], e[5]}, net); !added)
        return added;
    return {};
  });
  if (!balanced) return balanced.error();
  EdgeBalance balance;
  balance.unbalanced_edges = unbalanced.count;
  for (std::size_t i = 0; i < unbalanced.least.size(); ++i) {
    const Ends& e = unbalanced.least[i];
    balance.first[i].from = {e[0], e[1], e[2]};
    balance.first[i].to = {e[3], e[4], e[5]};
  }
  return balance;
}

void EdgeFaces::Faces::join(const Faces& other) {
  forward += other.forward;
  back += other.back;
  if (std::pair(other.triangle, other.corner) >= std::pair(triangle, corner)) return;
  triangle = other.triangle;
  corner = other.corner;
  first_forward = other.first_forward;
}

void EdgeFaces::look_at(const Triangles& chunk) {
  const std::size_t listed = balance_.listed();
  std::array<Faces, EdgeBalance::kListed> found;
  for (std::uint32_t i = 0; i < chunk.size(); ++i) {
    const Triangle triangle = chunk.corners(i);
    for (unsigned corner = 0; corner < 3; ++corner) {
      const Point &from = triangle[corner], &to = triangle[(corner + 1) % 3];
      for (std::size_t k = 0; k < listed; ++k) {
        const UnbalancedEdge& edge = balance_.first[k];
        const bool forward = from == edge.from && to == edge.to;
        if (forward || (from == edge.to && to == edge.from))
          found[k].join({forward, !forward, chunk.index(i), corner, forward});
      }
    }
  }
  const std::lock_guard lock(mutex_);
  for (std::size_t k = 0; k < listed; ++k) faces_[k].join(found[k]);
}

EdgeBalance EdgeFaces::balance() const {
  std::array<std::size_t, EdgeBalance::kListed> order{0, 1, 2};
  std::sort(order.begin(), order.end(), [this](std::size_t a, std::size_t b) {
    return std::pair(faces_[a].triangle, faces_[a].corner) <
           std::pair(faces_[b].triangle, faces_[b].corner);
  });
  EdgeBalance balance = balance_;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const Faces& faces = faces_[order[i]];
    UnbalancedEdge& edge = balance.first[i] = balance_.first[order[i]];
    edge.triangle = faces.triangle;
    edge.along = faces.first_forward ? faces.forward : faces.back;
    edge.against = faces.first_forward ? faces.back : faces.forward;
    if (!faces.first_forward) std::swap(edge.from, edge.to);
  }
  return balance;
}

void EdgeBalance::describe(int scale_exponent, storage::ModelRecord& model) const {
  model.unbalanced_edge_count = unbalanced_edges;
  for (std::size_t i = 0; i < listed(); ++i) {
    storage::UnbalancedEdge& edge = model.unbalanced_edge[i];
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      edge.from[axis] = std::ldexp(first[i].from[axis], -scale_exponent);
      edge.to[axis] = std::ldexp(first[i].to[axis], -scale_exponent);
    }
    edge.triangle = first[i].triangle;
    edge.along = first[i].along;
    edge.against = first[i].against;
  }
}

}  // namespace planetree::octree
