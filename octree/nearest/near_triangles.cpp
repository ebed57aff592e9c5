#include "octree/nearest/near_triangles.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "octree/nearest/near_triangles.cpp"
#include <hwy/foreach_target.h>

#include <bit>
#include <cassert>

#include "octree/geometry/strict_math.h"
#include "octree/geometry/triangle_kernels-inl.h"
#include "octree/geometry/work_limit.h"
#include "octree/nearest/near_walk-inl.h"

HWY_BEFORE_NAMESPACE();
namespace planetree::octree {
namespace HWY_NAMESPACE {

// Evaluates the distances of triangles, several at once.
class DistanceVisitor {
 public:
  static constexpr bool kMeasures = true;

  DistanceVisitor(const Point& query, NearTriangleSink& sink, TraversalStats& work)
      : query_(query), sink_(sink), work_(work) {}

  double reach() const { return sink_.reach(); }

  bool visit(const BlockView& block, unsigned near, TraversalWork& work_left) {
    if (!work_left.take(WorkUnits::kNearBlock)) return false;
    bool suffices = true;
    while (near != 0) {
      unsigned count = 0;
      for (; near != 0 && count < kTrianglesAtOnce; near &= near - 1) {
        numbers_[count] = static_cast<unsigned>(std::countr_zero(near));
        rows_.set(count, block.triangle(numbers_[count]));
        ++count;
      }
      // Rows of other triangles repeat the first.
      for (unsigned i = count; i < kTrianglesAtOnce; ++i) rows_.copy(0, i);
      suffices &= evaluate(block, (1U << count) - 1, work_left);
    }
    return suffices;
  }

 private:
  bool evaluate(const BlockView& block, unsigned selected, TraversalWork& work_left) {
    TriangleResults results;
    const TriangleView view = rows_.view(0);
    const unsigned refused = evaluate_selected(view, selected, query_, work_left, results);
    for (unsigned taken = selected & ~refused; taken != 0; taken &= taken - 1) {
      const auto lane = static_cast<unsigned>(std::countr_zero(taken));
      ++work_.triangles;
      sink_.take(results.of(lane), view.triangle(lane), block.id(numbers_[lane]));
    }
    return refused == 0;
  }

  const Point query_;
  NearTriangleSink& sink_;
  TraversalStats& work_;
  TriangleRows<kTrianglesAtOnce> rows_;
  unsigned numbers_[kTrianglesAtOnce];  // of the rows' triangles in their block
};

// Takes triangles as they are.
class CornerVisitor {
 public:
  static constexpr bool kMeasures = false;

  CornerVisitor(CorridorSink& sink, TraversalStats& work) : sink_(sink), work_(work) {}

  double reach() const { return sink_.reach(); }

  bool visit(const BlockView& block, unsigned near, TraversalWork& work_left) {
    if (!work_left.take(WorkUnits::kNearBlock)) return false;
    for (; near != 0; near &= near - 1) {
      const auto at = static_cast<unsigned>(std::countr_zero(near));
      ++work_.triangles;
      sink_.take(block.triangle(at), block.id(at));
    }
    return true;
  }

 private:
  CorridorSink& sink_;
  TraversalStats& work_;
};

double near_on_target(const TreeInfo& tree, const Point& query, NearTriangleSink& sink,
                      WorkLimit& limit, const PageReader& pages, TraversalStats& work,
                      const Corridor* corridor) {
  DistanceVisitor visitor(query, sink, work);
  return NearWalk(tree, query, corridor, visitor, limit, pages, work).run();
}

double in_corridor_on_target(const TreeInfo& tree, const Corridor& corridor, CorridorSink& sink,
                             WorkLimit& limit, const PageReader& pages, TraversalStats& work) {
  CornerVisitor visitor(sink, work);
  return NearWalk(tree, corridor.from, &corridor, visitor, limit, pages, work).run();
}

}  // namespace HWY_NAMESPACE
}  // namespace planetree::octree
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace planetree::octree {

HWY_EXPORT(near_on_target);
HWY_EXPORT(in_corridor_on_target);

double near_triangles(const TreeInfo& tree, const Point& query, NearTriangleSink& sink,
                      WorkLimit& limit, const PageReader& pages, TraversalStats& work,
                      const Corridor* corridor) noexcept {
  assert(query.cwiseAbs().maxCoeff() <= kMaxQueryCoordinate);
  return HWY_DYNAMIC_DISPATCH(near_on_target)(tree, query, sink, limit, pages, work, corridor);
}

double triangles_in_corridor(const TreeInfo& tree, const Corridor& corridor, CorridorSink& sink,
                             WorkLimit& limit, const PageReader& pages,
                             TraversalStats& work) noexcept {
  assert(corridor.from.cwiseAbs().maxCoeff() <= kMaxQueryCoordinate);
  return HWY_DYNAMIC_DISPATCH(in_corridor_on_target)(tree, corridor, sink, limit, pages, work);
}

}  // namespace planetree::octree
#endif
