#include "octree/builder/surface/cap_chain.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include "tests/octree/support/sample_tree.h"

namespace planetree::octree {
namespace {

struct Edge {
  Point from, to;
  std::int64_t count = 1;
};

std::vector<Triangle> close(const std::vector<Edge>& edges, std::uint64_t held_bytes = 1 << 20) {
  CapChain chain(held_bytes, spill_file());
  for (const Edge& edge : edges) EXPECT_TRUE(chain.add(edge.from, edge.to, edge.count));
  std::vector<Triangle> caps;
  EXPECT_TRUE(chain.close([&](const Triangle& cap) -> Result<void> {
    caps.push_back(cap);
    return {};
  }));
  return caps;
}

using Ends = std::pair<std::array<double, 3>, std::array<double, 3>>;

// What remains of the edges and of those of the caps: for each edge, how often it is traversed.
std::map<Ends, std::int64_t> rest(const std::vector<Edge>& edges,
                                  const std::vector<Triangle>& caps) {
  std::map<Ends, std::int64_t> net;
  const auto add = [&net](const Point& from, const Point& to, std::int64_t count) {
    const std::array<double, 3> a{from.x(), from.y(), from.z()}, b{to.x(), to.y(), to.z()};
    if (a == b) return;
    const Ends ends = a < b ? Ends(a, b) : Ends(b, a);
    net[ends] += a < b ? count : -count;
    if (net[ends] == 0) net.erase(ends);
  };
  for (const Edge& edge : edges) add(edge.from, edge.to, edge.count);
  for (const Triangle& cap : caps)
    for (std::size_t k = 0; k < 3; ++k) add(cap[k], cap[(k + 1) % 3], 1);
  return net;
}

std::vector<Edge> ring(unsigned count, std::int64_t copies = 1, double height = 0) {
  const auto at = [&](unsigned i) {
    const double a = 2 * std::numbers::pi * (i % count) / count;
    return Point(std::cos(a), std::sin(a), height);
  };
  std::vector<Edge> edges;
  for (unsigned i = 0; i < count; ++i) edges.push_back({at(i), at(i + 1), copies});
  return edges;
}

TEST(CapChain, ClosesAHoleOfThreeEdgesByOneCap) {
  const Point a(0, 0, 0), b(1, 0, 0), c(0, 1, 0);
  const std::vector<Edge> edges{{a, b}, {b, c}, {c, a}};
  const std::vector<Triangle> caps = close(edges);
  ASSERT_EQ(caps.size(), 1u);
  EXPECT_TRUE(rest(edges, caps).empty());
}

TEST(CapChain, ClosesARingByTwoCapsLessThanItHasEdges) {
  for (const unsigned count : {3u, 4u, 5u, 17u, 1000u}) {
    const std::vector<Edge> edges = ring(count);
    const std::vector<Triangle> caps = close(edges);
    EXPECT_EQ(caps.size(), count - 2);
    EXPECT_TRUE(rest(edges, caps).empty());
  }
}

// Most caps are about as long as the edges.
TEST(CapChain, MakesFewLongCaps) {
  const unsigned count = 4096;
  const double edge = 2 * std::numbers::pi / count;
  double lengths = 0;
  for (const Triangle& cap : close(ring(count))) lengths += (cap[1] - cap[0]).norm();
  // Of a fan, the mean would be about 1.
  EXPECT_LT(lengths / count, 40 * edge);
}

TEST(CapChain, ClosesEdgesOfSeveralCopies) {
  const std::vector<Edge> edges = ring(12, 5);
  const std::vector<Triangle> caps = close(edges);
  EXPECT_EQ(caps.size(), 50u);
  EXPECT_TRUE(rest(edges, caps).empty());
}

TEST(CapChain, ClosesHolesThatMeetAtVertices) {
  const Point o(0, 0, 0);
  std::vector<Edge> edges;
  for (int i = 0; i < 9; ++i) {
    const Point a(1, i, 0), b(1, i + 0.5, 1);
    edges.insert(edges.end(), {{o, a}, {a, b}, {b, o}});
  }
  // One is inverted, and one is there twice.
  edges.insert(edges.end(), {{o, {2, 0, 1}}, {{2, 0, 1}, {2, 1, 0}}, {{2, 1, 0}, o}});
  edges.push_back({{1, 0, 0}, o, 2});
  edges.push_back({o, {1, 0.5, 1}, 2});
  edges.push_back({{1, 0.5, 1}, {1, 0, 0}, 2});
  EXPECT_TRUE(rest(edges, close(edges)).empty());
}

TEST(CapChain, MakesTheSameCapsInAnyOrderAndMemory) {
  std::vector<Edge> edges = ring(500);
  for (const Edge& edge : ring(300, 2, 1)) edges.push_back(edge);
  const std::vector<Triangle> expected = close(edges);
  EXPECT_TRUE(rest(edges, expected).empty());
  std::reverse(edges.begin(), edges.end());
  for (const std::uint64_t held_bytes : {0u, 5000u, 1u << 20})
    EXPECT_EQ(close(edges, held_bytes), expected) << held_bytes;
}

TEST(CapChain, MakesNoCapsOfNoEdges) { EXPECT_TRUE(close({}).empty()); }

TEST(CapChain, PassesOnErrorsOfTheSink) {
  CapChain chain(1 << 20, spill_file());
  for (const Edge& edge : ring(9)) ASSERT_TRUE(chain.add(edge.from, edge.to, edge.count));
  const auto closed = chain.close([](const Triangle&) -> Result<void> {
    return make_error(ErrorCode::kNoSpace, Error::kNowhere, Error::kNowhere, "full");
  });
  ASSERT_FALSE(closed);
  EXPECT_EQ(closed.error().code, ErrorCode::kNoSpace);
}

}  // namespace
}  // namespace planetree::octree
