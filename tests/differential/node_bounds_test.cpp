// The bounds that nodes store for their children hold, after quantising and in float.

#include "octree/traversal/bounds.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <hwy/targets.h>

#include "octree/traversal/nearby_lists.h"
#include "octree/traversal/node_kernels-inl.h"
#include "octree/traversal/overlap.h"
#include "octree/traversal/triangle_filter-inl.h"
#include "tests/differential/tree_pages.h"
#include "tests/oracle/nasty_models.h"
#include "tests/oracle/random.h"

namespace planetree::oracle {
namespace {

using octree::FloatQuery;
using octree::Node;
using octree::Point;
using octree::Triangle;

Vec3 plain(const Point& p) { return {p.x(), p.y(), p.z()}; }
Corners plain(const Triangle& t) { return {plain(t[0]), plain(t[1]), plain(t[2])}; }

FloatQuery float_query(const TreePages& pages, const Point& query) {
  const Point from = query - pages.centre();
  return FloatQuery::from(from.x(), from.y(), from.z());
}

// A child's box holds every corner below it. Stored numbers are used as they are; corners may
// exceed them by the rounding of the centre alone.
void expect_encloses(const Node& node, unsigned child, const Point& from_centre, double slack) {
  const octree::FloatBox box = child_box(node, child);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    EXPECT_LE(box.lower[axis], from_centre[static_cast<int>(axis)] + slack);
    EXPECT_GE(box.upper[axis], from_centre[static_cast<int>(axis)] - slack);
  }
}

void expect_enclosing_nodes(const TreePages& pages) {
  constexpr double kSlack = 0x1p-50;
  pages.each_node([&](const Node& node) {
    for (unsigned child = 0; child < node.child_count; ++child)
      for (const Triangle& triangle : pages.triangles(node.link[child]))
        for (const Point& corner : triangle)
          expect_encloses(node, child, corner - pages.centre(), kSlack);
  });
}

// No bound of a child excludes the child at its true distance.
void expect_bounds_below(const Node& node, unsigned child, const Soup& below,
                         const TreePages& pages, const Point& query) {
  const FloatQuery wide = float_query(pages, query);
  const auto distance = static_cast<double>(extended_distance(plain(query), below));
  const float threshold = octree::prune_threshold(wide, distance);
  for (const bool discs : {false, true}) {
    octree::FrontierGroup group;
    const auto children =
        octree::HWY_NAMESPACE::sorted_children(node, wide, discs, threshold, group);
    const unsigned near = children.count;
    const auto* const at = std::find(group.link, group.link + near, node.link[child]);
    ASSERT_NE(at, group.link + near)
        << (discs ? "disc" : "box") << " distance " << distance << " slack " << wide.slack;
    EXPECT_EQ(node.link[children.child()], group.link[0]);
    EXPECT_EQ(children.bound(), group.bound(0));
    if (wide.usable) {
      const float bound = group.bound(static_cast<unsigned>(at - group.link));
      EXPECT_LE(octree::certified(wide, bound), distance * (1 + 1e-15) + 0x1p-500);
    }
  }
}

Soup below(const TreePages& pages, std::uint32_t link) {
  Soup soup;
  for (const Triangle& triangle : pages.triangles(link)) soup.push_back(plain(triangle));
  return soup;
}

// Bounds of nasty models hold for nasty queries.
TEST(NodeBounds, HoldAfterQuantising) {
  for (const NastyFamily& family : nasty_families()) {
    SCOPED_TRACE(std::string(family.name));
    Random random(6);
    for (int repeat = 0; repeat < 3; ++repeat) {
      const BuiltModel model(family.make(random), {4096, 1 << 20, 1});
      const TreePages pages(model.path());
      expect_enclosing_nodes(pages);
      pages.each_node([&](const Node& node) {
        for (unsigned child = 0; child < node.child_count; ++child) {
          const Soup soup = below(pages, node.link[child]);
          for (int i = 0; i < 20; ++i) {
            const Vec3 q = nasty_query(random, soup, 1);
            expect_bounds_below(node, child, soup, pages, Point(q.x, q.y, q.z));
          }
        }
      });
    }
  }
}

// Clusters so small that their boxes are a float's ulp or two wide: the box's centre is then as far
// off as its corner.
Soup ulp_cluster(Random& random, double width) {
  const Vec3 at{0.5, 0.5, 0.5};
  Soup triangles;
  // So many that they are not taken for strays.
  for (int i = 0; i < 400; ++i) {
    triangles.push_back(
        {Vec3{-0.99, -0.99, -0.99}, Vec3{-0.98, -0.99, -0.99}, Vec3{-0.99, -0.98, -0.99}});
    triangles.push_back({Vec3{0.99, 0.99, 0.99}, Vec3{0.98, 0.99, 0.99}, Vec3{0.99, 0.98, 0.99}});
  }
  for (int i = 0; i < 20000; ++i) {
    const double along = i < 2000 ? random.unit() : random.between(0.9, 1);
    const auto corner = [&] {
      const auto coordinate = [&] { return width * (along - 0.02 * random.unit()); };
      return at + Vec3{coordinate(), coordinate(), coordinate()};
    };
    triangles.push_back({corner(), corner(), corner()});
  }
  return triangles;
}

TEST(NodeBounds, HoldInBoxesOfFewUlps) {
  constexpr double kUlp = 0x1p-24;
  Random random(5);
  for (const double width : {kUlp, 2 * kUlp, 3 * kUlp}) {
    const BuiltModel model(ulp_cluster(random, width));
    const TreePages pages(model.path());
    int tested = 0;
    pages.each_node([&](const Node& node) {
      for (unsigned child = 0; child < node.child_count; ++child) {
        const octree::FloatBox box = child_box(node, child);
        if (box.upper[0] - box.lower[0] > 8 * kUlp) continue;
        if (!octree::LinkFormat::is_leaf(node.link[child])) continue;
        if (++tested % 16 != 0) continue;
        const Soup soup = below(pages, node.link[child]);
        for (int step = -4; step <= 6; ++step)
          for (const double part : {-0.4999, 0.4999}) {
            const double at = 0.5 + kUlp * (step + part);
            expect_bounds_below(node, child, soup, pages, Point(at, at, at));
          }
      }
    });
    EXPECT_GT(tested, 100);
  }
}

namespace on_target = octree::HWY_NAMESPACE;

// The float filter passes every triangle that is no farther than the limit, and its upper bound is
// no less than the nearest distance. filter(local query, limit, filtered) runs it; the local query
// is relative to `origin`.
template <class Filter>
void expect_filter_passes(const std::vector<Triangle>& triangles, const FloatQuery& wide,
                          const Point& query, const Point& origin, float extent,
                          const Filter& filter) {
  const Point from = query - origin;
  const float local[3] = {static_cast<float>(from.x()), static_cast<float>(from.y()),
                          static_cast<float>(from.z())};
  on_target::FilteredTriangles filtered;
  double nearest = std::numeric_limits<double>::infinity();
  for (unsigned i = 0; i < triangles.size(); ++i) {
    const double reach = std::sqrt(octree::triangle_value(query, triangles[i]).squared);
    filter(local, octree::filter_threshold(wide, reach, extent), filtered);
    EXPECT_TRUE((filtered.near >> i & 1) != 0) << "value " << std::sqrt(filtered.squared[i])
                                               << " distance " << reach << " extent " << extent;
    nearest = std::min(nearest, reach);
  }
  if (wide.usable && extent >= octree::kFilterMinExtent) {
    EXPECT_GE(octree::filter_upper(filtered.min_upper, extent), nearest);
  }
}

void expect_block_passes(const octree::BlockView& block, const FloatQuery& wide,
                         const Point& query) {
  std::vector<Triangle> triangles;
  for (unsigned i = 0; i < block.triangle_count(); ++i) triangles.push_back(block.triangle(i));
  expect_filter_passes(triangles, wide, query, block.vertex(0), block.header().extent,
                       [&](const auto& local, float limit, auto& filtered) {
                         on_target::filter_block(block.header(), local, limit, filtered);
                       });
}

// The same triangles as a list relative to some point.
void expect_list_passes(const octree::BlockView& block, const FloatQuery& wide, const Point& query,
                        const Point& centre) {
  std::vector<Triangle> triangles;
  std::vector<octree::NearbyTriangle> found;
  for (unsigned i = 0; i < block.triangle_count(); ++i) {
    triangles.push_back(block.triangle(i));
    found.push_back({triangles.back(), block.id(i), 0});
  }
  octree::NearbyTriangles list;
  list.fill(found, centre, 0, 1);
  if (!list.complete()) return;
  expect_filter_passes(triangles, wide, query, centre, list.extent(),
                       [&](const auto& local, float limit, auto& filtered) {
                         on_target::filter_triangles(on_target::NearbyTriangleLanes(list, local),
                                                     list.size(), limit, filtered);
                       });
}

// Every instruction set finds the same triangles at the same distances.
void expect_found_alike(const octree::BlockView& block, const FloatQuery& wide, const Point& query,
                        double distance) {
  double first[octree::kMaxBlockTriangles], nearest[octree::kMaxBlockTriangles];
  const unsigned near = octree::triangles_within(block, query, wide, distance, first);
  for (std::int64_t left = hwy::SupportedTargets(); left != 0; left &= left - 1) {
    hwy::SetSupportedTargetsForTest(left & -left);
    EXPECT_EQ(octree::triangles_within(block, query, wide, distance, nearest), near);
    for (unsigned i = 0; i < block.triangle_count(); ++i)
      EXPECT_TRUE((near >> i & 1) == 0 || nearest[i] == first[i]) << i;
    hwy::SetSupportedTargetsForTest(0);
  }
}

// All triangles as near as a given one are found, and none is reported farther than it is.
void expect_found_within(const octree::BlockView& block, const FloatQuery& wide, const Point& query,
                         unsigned which) {
  std::vector<double> distances;
  for (unsigned i = 0; i < block.triangle_count(); ++i)
    distances.push_back(std::sqrt(octree::triangle_value(query, block.triangle(i)).squared));
  const double distance = distances[which % distances.size()];
  double nearest[octree::kMaxBlockTriangles];
  const unsigned near = octree::triangles_within(block, query, wide, distance, nearest);
  EXPECT_EQ(near >> distances.size(), 0u);
  if (which % 8 == 0) expect_found_alike(block, wide, query, distance);
  for (unsigned i = 0; i < distances.size(); ++i) {
    const bool found = (near >> i & 1) != 0;
    EXPECT_TRUE(found || distances[i] > distance) << distances[i] << " and " << distance;
    if (!found) continue;
    EXPECT_LE(nearest[i], distances[i] * (1 + 0x1p-40));
  }
}

TEST(TriangleFilter, NeverRejectsTheNearest) {
  for (const NastyFamily& family : nasty_families()) {
    SCOPED_TRACE(std::string(family.name));
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
      Random random(seed);
      const BuiltModel model(family.make(random), {4096, 1 << 20, 1});
      const TreePages pages(model.path());
      const auto check = [&](std::uint32_t link) {
        const octree::BlockView block = pages.block(link);
        const Soup soup = below(pages, link);
        for (int k = 0; k < 40; ++k) {
          const Vec3 q = nasty_query(random, soup, 1), c = nasty_query(random, soup, 1);
          const Point query(q.x, q.y, q.z), centre(c.x, c.y, c.z);
          const FloatQuery wide = float_query(pages, query);
          expect_block_passes(block, wide, query);
          expect_found_within(block, wide, query, static_cast<unsigned>(k));
          if (wide.usable && float_query(pages, centre).usable)
            expect_list_passes(block, wide, query, centre);
        }
      };
      if (octree::LinkFormat::is_leaf(pages.root_link())) check(pages.root_link());
      pages.each_node([&](const Node& node) {
        for (unsigned child = 0; child < node.child_count; ++child)
          if (octree::LinkFormat::is_leaf(node.link[child])) check(node.link[child]);
      });
    }
  }
}

}  // namespace
}  // namespace planetree::oracle
