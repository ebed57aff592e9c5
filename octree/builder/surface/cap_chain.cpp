#include "octree/builder/surface/cap_chain.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstring>
#include <memory>
#include <span>
#include <tuple>
#include <utility>

#include "octree/geometry/strict_math.h"
#include "storage/file/checksum.h"

namespace planetree::octree {
namespace {

using Vertex = std::array<double, 3>;

/// Number of edges that are sorted at a time.
constexpr std::size_t kEdgesAtOnce = 1 << 16;

Vertex vertex_of(const Point& point) { return {point.x(), point.y(), point.z()}; }
Point point_of(const Vertex& vertex) { return {vertex[0], vertex[1], vertex[2]}; }

std::uint64_t hash_of(const Vertex& vertex, std::uint64_t round) {
  const std::array<double, 4> words{vertex[0], vertex[1], vertex[2], static_cast<double>(round)};
  return storage::hash64(std::as_bytes(std::span(words)));
}

}  // namespace

/// Takes the vertices of one round. An edge belongs to that of its vertices with the lesser hash.
class CapChain::Round {
 public:
  Round(std::uint64_t number, std::uint64_t held_bytes, storage::SpillFile& file,
        const CapSink& sink)
      : number_(number), next_(sizeof(Edge), held_bytes, file), sink_(sink) {}

  static Edge edge(const Vertex& from, const Vertex& to, std::int64_t count, std::uint64_t round) {
    const std::uint64_t from_hash = hash_of(from, round), to_hash = hash_of(to, round);
    if (std::tie(from_hash, from) < std::tie(to_hash, to)) return {{from_hash, 0}, from, to, count};
    return {{to_hash, 0}, to, from, -count};
  }
  static Result<void> spill(std::vector<Edge>& edges, storage::SpillRuns& runs) {
    std::sort(edges.begin(), edges.end(),
              [](const Edge& a, const Edge& b) { return a.key < b.key; });
    std::vector<std::byte> records(edges.size() * sizeof(Edge));
    if (!edges.empty()) std::memcpy(records.data(), edges.data(), records.size());
    edges.clear();
    const auto added = runs.add(std::move(records));
    if (!added) return added.error();
    return {};
  }

  // Takes the edges of all vertices whose hashes are in some range.
  Result<void> take(std::vector<Edge> edges) {
    std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
      return std::tie(a.key, a.vertex, a.other) < std::tie(b.key, b.vertex, b.other);
    });
    for (std::size_t first = 0, end = 0; first < edges.size(); first = end) {
      while (end < edges.size() && edges[end].vertex == edges[first].vertex) ++end;
      if (const auto taken = take_vertex(std::span(edges).subspan(first, end - first)); !taken)
        return taken;
    }
    return {};
  }
  // Returns the edges that are left for the next round.
  Result<storage::SpillRuns*> finish() {
    if (const auto spilled = spill(left_, next_); !spilled) return spilled.error();
    return &next_;
  }

 private:
  struct Side {
    Vertex other;
    std::int64_t count;
  };

  // Pairs edges that enter a vertex with edges that leave it.
  Result<void> take_vertex(std::span<const Edge> edges) {
    const Vertex vertex = edges[0].vertex;
    std::vector<Side> in, out;
    for (std::size_t i = 0; i < edges.size();) {
      const Vertex& other = edges[i].other;
      std::int64_t net = 0;
      for (; i < edges.size() && edges[i].other == other; ++i) net += edges[i].net;
      if (net != 0) (net < 0 ? in : out).push_back({edges[i - 1].other, net < 0 ? -net : net});
    }
    std::size_t i = 0, o = 0;
    while (i < in.size() && o < out.size()) {
      const std::int64_t count = std::min(in[i].count, out[o].count);
      const Triangle cap{point_of(in[i].other), point_of(vertex), point_of(out[o].other)};
      for (std::int64_t copy = 0; copy < count; ++copy)
        if (const auto sunk = sink_(cap); !sunk) return sunk;
      if (const auto kept = keep(in[i].other, out[o].other, count); !kept) return kept;
      if ((in[i].count -= count) == 0) ++i;
      if ((out[o].count -= count) == 0) ++o;
    }
    for (; i < in.size(); ++i)
      if (const auto kept = keep(in[i].other, vertex, in[i].count); !kept) return kept;
    for (; o < out.size(); ++o)
      if (const auto kept = keep(vertex, out[o].other, out[o].count); !kept) return kept;
    return {};
  }

  Result<void> keep(const Vertex& from, const Vertex& to, std::int64_t count) {
    left_.push_back(edge(from, to, count, number_ + 1));
    return left_.size() < kEdgesAtOnce ? Result<void>() : spill(left_, next_);
  }

  const std::uint64_t number_;
  std::vector<Edge> left_;
  storage::SpillRuns next_;
  const CapSink& sink_;
};

CapChain::CapChain(std::uint64_t held_bytes, storage::SpillFile& file)
    : held_bytes_(held_bytes), file_(file), edges_(sizeof(Edge), held_bytes / 2, file) {}

// Caps run along the boundary the other way.
Result<void> CapChain::add(const Point& from, const Point& to, std::int64_t count) {
  added_.push_back(Round::edge(vertex_of(to), vertex_of(from), count, 0));
  return added_.size() < kEdgesAtOnce ? Result<void>() : Round::spill(added_, edges_);
}

Result<void> CapChain::close(const CapSink& sink) {
  if (const auto spilled = Round::spill(added_, edges_); !spilled) return spilled;
  const storage::SpillRuns* edges = &edges_;
  std::unique_ptr<Round> last;
  for (std::uint64_t number = 0; edges->size() > 0; ++number) {
    auto round = std::make_unique<Round>(number, held_bytes_ / 2, file_, sink);
    // The hashes are divided into equal ranges; their number is a power of two.
    const std::uint64_t shares = std::bit_ceil(edges->size() / kEdgesAtOnce + 1);
    storage::SpillRuns::Cut from = edges->begin();
    for (std::uint64_t share = 1; share <= shares; ++share) {
      auto to = share < shares ? edges->cut({share * (~std::uint64_t{0} / shares + 1), 0})
                               : Result<storage::SpillRuns::Cut>(edges->end());
      if (!to) return to.error();
      const auto records = edges->read(from, *to);
      if (!records) return records.error();
      std::vector<Edge> some(records->size() / sizeof(Edge));
      if (!some.empty()) std::memcpy(some.data(), records->data(), records->size());
      if (const auto taken = round->take(std::move(some)); !taken) return taken;
      from = *std::move(to);
    }
    const auto left = round->finish();
    if (!left) return left.error();
    edges = *left;
    last = std::move(round);
  }
  return {};
}

}  // namespace planetree::octree
