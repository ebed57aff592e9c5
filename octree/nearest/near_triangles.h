#pragma once

#include <cstdint>

#include "octree/geometry/triangle_distance.h"
#include "octree/traversal/tree_view.h"

namespace planetree::octree {

class WorkLimit;

/// All points within a margin of a segment; model frame, no coordinate beyond kMaxQueryCoordinate.
struct Corridor {
  Point from, to;
  double margin = 0;
};

/// Receives the triangles that near_triangles() finds, in any order, each once.
class NearTriangleSink {
 public:
  /// Distance beyond which no triangle is wanted, as triangles are evaluated; model frame. It may
  /// shrink while triangles are taken.
  virtual double reach() const noexcept = 0;
  /// Takes a triangle. Its distance may exceed reach().
  virtual void take(const TriangleResult& result, const Triangle& corners,
                    std::uint64_t index) noexcept = 0;

 protected:
  // Not virtual: a sink may lie in an arena, where nobody runs destructors.
  ~NearTriangleSink() = default;
};

/// Receives the triangles that triangles_in_corridor() finds, in any order, each once.
class CorridorSink {
 public:
  virtual ~CorridorSink() = default;

  /// Distance from the corridor's start beyond which no triangle is wanted; model frame. It may
  /// shrink while triangles are taken.
  virtual double reach() const noexcept = 0;
  /// Takes a triangle, which may be outside of the corridor and beyond reach().
  virtual void take(const Triangle& corners, std::uint64_t index) noexcept = 0;
};

/// Finds the triangles near a query by a traversal of the tree, nearest child first.
///
/// query    model frame, no coordinate beyond kMaxQueryCoordinate.
/// corridor leaves out triangles that have no point in it; null: none
/// work     counters that the traversal adds to; `limit` counts its units.
/// return   a lower bound on the distance of every triangle within sink.reach() that was not taken
///          because its page was missing or the work was spent; infinity if there is none.
/// threads  any; no allocation, no lock, no exception of its own.
/// source   as nearest().
double near_triangles(const TreeInfo& tree, const Point& query, NearTriangleSink& sink,
                      WorkLimit& limit, const PageReader& pages, TraversalStats& work,
                      const Corridor* corridor = nullptr) noexcept;

/// Finds the triangles that have a point in a corridor, from its start on; else as
/// near_triangles().
double triangles_in_corridor(const TreeInfo& tree, const Corridor& corridor, CorridorSink& sink,
                             WorkLimit& limit, const PageReader& pages,
                             TraversalStats& work) noexcept;

}  // namespace planetree::octree
