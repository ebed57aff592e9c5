#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <vector>

#include "octree/builder/sort/triangles.h"
#include "octree/geometry/triangle_distance.h"
#include "storage/file/file_layout.h"
#include "storage/spill/spill_runs.h"

namespace planetree::octree {

/// An edge that more faces run along one way than the other.
struct UnbalancedEdge {
  std::uint64_t triangle = kNoTriangle;  ///< the first that has it
  Point from = Point::Zero();            ///< its ends as that triangle runs along it,
  Point to = Point::Zero();              ///< model frame
  std::uint32_t along = 0;               ///< faces that run from `from` to `to`
  std::uint32_t against = 0;             ///< faces that run the other way
};

/// Whether a surface closes: it does if as many faces run along every edge one way as the
/// other, edges being the same where their ends are. Then, and only then, winding numbers are
/// whole and constant off the surface; so soups of closed surfaces, doubled ones and edges of
/// four faces count as closed.
struct EdgeBalance {
  static constexpr std::size_t kListed = 3;

  std::uint64_t unbalanced_edges = 0;
  /// How many of them are listed.
  std::size_t listed() const {
    return static_cast<std::size_t>(std::min<std::uint64_t>(unbalanced_edges, kListed));
  }
  /// Those of them whose ends have the least coordinates.
  std::array<UnbalancedEdge, kListed> first;

  /// Writes what is known into the model's record, in the input's units.
  void describe(int scale_exponent, storage::ModelRecord& model) const;
};

/// Balances a model's edges patch by patch: what does not come out even within a patch is put
/// away, and balanced with what the others left over.
class EdgeCensus {
 public:
  /// Of an edge that is put away.
  static constexpr std::size_t kEdgeBytes = 72;

  /// held_bytes  of what is put away may stay in memory.
  /// file        takes the rest; must outlive this.
  EdgeCensus(std::uint64_t held_bytes, storage::SpillFile& file);

  /// A part of the model. Any number of threads; the result does not depend on the parts.
  Result<void> add(const Triangles& chunk);

  /// After the last part: how many edges are open, and the ends of those listed.
  /// Uses the calling thread's TBB arena.
  Result<EdgeBalance> balance();

 private:
  storage::SpillRuns left_over_;
};

/// Finds out which faces the listed open edges have, by another look at all parts of the model.
class EdgeFaces {
 public:
  explicit EdgeFaces(const EdgeBalance& balance) : balance_(balance) {}

  /// Any number of threads.
  void look_at(const Triangles& chunk);
  /// The balance with what was found, the listed edges by their first triangle, then corner.
  EdgeBalance balance() const;

 private:
  struct Faces {
    std::uint32_t forward = 0, back = 0;  // from the lesser end on, and to it
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
