#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "octree/geometry/triangle_distance.h"
#include "planetree/error.h"
#include "storage/spill/spill_runs.h"

namespace planetree::octree {

/// Receives a cap triangle.
using CapSink = std::function<Result<void>(const Triangle& cap)>;

/// Closes a surface with triangles, the caps. The surface's unbalanced edges, each with its
/// direction and its multiplicity, are the boundary of a chain, so that as many of them enter a
/// vertex as leave it. A cap replaces two edges that meet at a vertex, p to v and v to n, by the
/// edge from p to n. This goes on until no edge is left. Then the surface and the caps together are
/// watertight.
///
/// Rounds take one vertex in three, chosen by a hash of its coordinates, so that a hole of n edges
/// gets n - 2 caps, most of which are as small as the edges. A hole of three edges gets the missing
/// triangle. The caps depend on the edges alone.
///
/// threads  one at a time.
/// source   the idea of whole winding numbers of a closed surface less the solid angles of the
///          closure is from Martens, Trettner and Bessmeltsev 2026, "Antipodal winding numbers",
///          arXiv 2605.01536. Caps are planetree's own.
class CapChain {
 public:
  /// held_bytes  maximum of edges in memory.
  /// file        receives the others; must outlive this.
  CapChain(std::uint64_t held_bytes, storage::SpillFile& file);

  /// Adds an edge of the surface's boundary. `count` more faces run from `from` to `to` than back.
  Result<void> add(const Point& from, const Point& to, std::int64_t count);

  /// Makes the caps. Call it once, after the last edge.
  /// errors  those of SpillFile and `sink`.
  Result<void> close(const CapSink& sink);

 private:
  // An edge that caps still have to run along, from the vertex that its round takes to the other.
  struct Edge {
    storage::SpillKey key;  // hash of `vertex`
    std::array<double, 3> vertex{}, other{};
    std::int64_t net = 0;  // runs from `vertex` to `other` minus runs back
  };
  static_assert(sizeof(Edge) == 72);
  class Round;

  const std::uint64_t held_bytes_;
  storage::SpillFile& file_;
  std::vector<Edge> added_;
  storage::SpillRuns edges_;  // of the first round
};

}  // namespace planetree::octree
