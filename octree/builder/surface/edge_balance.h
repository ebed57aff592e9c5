#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <utility>
#include <vector>

#include "octree/builder/sort/triangles.h"
#include "octree/builder/surface/cap_chain.h"
#include "octree/geometry/triangle_distance.h"
#include "storage/file/file_layout.h"
#include "storage/spill/spill_runs.h"

namespace planetree::octree {

/// An edge along which more faces run in one direction than in the other.
struct UnbalancedEdge {
  std::uint64_t triangle = kNoTriangle;  ///< index of the first triangle that has the edge
  Point from = Point::Zero();            ///< its ends in the direction of that triangle,
  Point to = Point::Zero();              ///< model frame
  std::uint32_t along = 0;               ///< faces that run from `from` to `to`
  std::uint32_t against = 0;             ///< faces that run the other way
};

/// Whether a surface is watertight: whether as many faces run along every edge in one direction as
/// in the other. Edges are the same if their ends are. Then, and only then, winding numbers are
/// whole and constant off the surface. So several closed surfaces together, doubled surfaces, and
/// edges of four faces count as watertight.
struct EdgeBalance {
  static constexpr std::size_t kListed = 3;

  std::uint64_t unbalanced_edges = 0;
  /// Number of unbalanced edges that are listed.
  std::size_t listed() const {
    return static_cast<std::size_t>(std::min<std::uint64_t>(unbalanced_edges, kListed));
  }
  /// The listed ones: those whose ends have the least coordinates.
  std::array<UnbalancedEdge, kListed> first;

  /// Writes the balance into the model record, in the input's units.
  void describe(int scale_exponent, storage::ModelRecord& model) const;
};

/// Balances the edges of a model chunk by chunk. Edges that are not balanced within a chunk are
/// stored and balanced with those that the other chunks leave over.
class EdgeCensus {
 public:
  /// Length of the record of a stored edge.
  static constexpr std::size_t kEdgeBytes = 72;

  /// held_bytes  maximum of stored edges in memory.
  /// file        receives the others; must outlive this.
  EdgeCensus(std::uint64_t held_bytes, storage::SpillFile& file);

  /// Adds a part of the model. Any number of threads; the result does not depend on the division
  /// into parts.
  Result<void> add(const Triangles& chunk);

  /// Where the edges are in the file that were left over so far, if none is in memory.
  std::vector<storage::SpillRuns::Extent> extents() const { return left_over_.extents(); }
  /// Adds edges that another census left over, and that are in the file.
  void add_extent(storage::SpillRuns::Extent edges) { left_over_.add_extent(std::move(edges)); }

  /// Returns the number of unbalanced edges, and the ends of those listed. Call it after the last
  /// part. Uses the calling thread's TBB arena.
  ///
  /// boundary  receives every unbalanced edge; may be null.
  /// errors    those of SpillFile and CapChain.
  Result<EdgeBalance> balance(CapChain* boundary);

 private:
  storage::SpillRuns left_over_;
};

/// Finds the faces of the listed unbalanced edges, in a second pass over all parts of the model.
class EdgeFaces {
 public:
  explicit EdgeFaces(const EdgeBalance& balance) : balance_(balance) {}

  /// Looks at a part of the model. Any number of threads.
  void look_at(const Triangles& chunk);
  /// The balance with what was found; listed edges are in the order of their first triangle, then
  /// of its corner.
  EdgeBalance balance() const;

 private:
  struct Faces {
    std::uint32_t forward = 0, back = 0;  // faces from the lesser end to the greater, and back
    std::uint64_t triangle = kNoTriangle;
    unsigned corner = 0;
    bool first_forward = true;

    void join(const Faces& other);
  };

  const EdgeBalance balance_;
  std::mutex mutex_;
  std::array<Faces, EdgeBalance::kListed> faces_;
};

}  // namespace planetree::octree
