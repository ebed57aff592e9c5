// Checks the moments that the specification states, and the share of a winding number computed from
// them, against every triangle.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "tests/golden/samples.h"
#include "tests/golden/spec_tree.h"

namespace planetree::golden {
namespace {

SpecPoint minus(const SpecPoint& a, const SpecPoint& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

SpecPoint cross(const SpecPoint& a, const SpecPoint& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

double dot(const SpecPoint& a, const SpecPoint& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

double length(const SpecPoint& a) { return std::sqrt(dot(a, a)); }

SpecPoint middle_of(const SpecChild& child) {
  return {child.disc.middle[0], child.disc.middle[1], child.disc.middle[2]};
}

// The integrals of "Moments", summed over triangles: each counts as a point at its centroid plus
// its own second moment.
struct Integrals {
  double area = 0, second = 0;
  SpecPoint vector{};
  std::array<SpecPoint, 3> first{};
};

Integrals integrate(const SpecTree& tree, const SpecChild& child) {
  Integrals sum;
  const SpecPoint middle = middle_of(child);
  for (const SpecTriangle& triangle : tree.triangles(child.link)) {
    std::array<SpecPoint, 3> e{};
    for (std::size_t k = 0; k < 3; ++k)
      e[k] = minus(minus(triangle.corners[k], tree.header().centre), middle);
    SpecPoint half = cross(minus(e[1], e[0]), minus(e[2], e[0]));
    for (double& part : half) part /= 2;
    const double area = length(half);
    sum.area += area;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double x = e[0][axis], y = e[1][axis], z = e[2][axis];
      sum.second += area * (x * x + y * y + z * z + x * y + y * z + z * x) / 6;
      sum.vector[axis] += half[axis];
      for (std::size_t other = 0; other < 3; ++other)
        sum.first[axis][other] += (x + y + z) / 3 * half[other];
    }
  }
  return sum;
}

double off(const std::array<SpecPoint, 3>& stored, const std::array<SpecPoint, 3>& g) {
  const double trace = g[0][0] + g[1][1] + g[2][2];
  double sum = 0;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) {
      const double part = stored[i][j] - (g[i][j] + g[j][i]) / 2 + (i == j ? trace / 3 : 0);
      sum += part * part;
    }
  return std::sqrt(sum);
}

// far() of "Side of a point: any other surface".
struct FarShare {
  double value, error;
};

FarShare far(const SpecTree& tree, const SpecChild& child, const SpecPoint& p) {
  const SpecPoint q = minus(p, tree.header().centre), d = minus(middle_of(child), q);
  const double slack =
      0x1p-50 * (1 + std::max({std::fabs(q[0]), std::fabs(q[1]), std::fabs(q[2])}));
  SpecPoint gap{}, edges{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double lower = child.box.lower[axis], upper = child.box.upper[axis];
    gap[axis] = std::max({0.0, lower - q[axis], q[axis] - upper});
    edges[axis] = upper - lower;
  }
  const double rho = length(gap) - slack, way = length(d), s = length(edges) / 2 / way;
  if (!(rho > 0)) return {0, std::numeric_limits<double>::infinity()};
  double t = 3 / std::pow(rho, 4);
  if (s < 1) t = std::min(t, (3 - 2 * s) / ((1 - s) * (1 - s)) / std::pow(way, 4));
  const SpecMoments& m = child.moments;
  const SpecPoint turned = {dot(m.first[0], d), dot(m.first[1], d), dot(m.first[2], d)};
  const double value = dot(m.vector, d) / std::pow(way, 3) - 3 * dot(d, turned) / std::pow(way, 5);
  const double error = 0x1p-15 * m.area / (way * way) +
                       5.25 * std::sqrt(m.area * m.second) / 127 / std::pow(way, 3) + m.second * t +
                       2 * slack * m.area / std::pow(rho, 3);
  return {value / (4 * std::numbers::pi), error / (4 * std::numbers::pi)};
}

double winding(const SpecTree& tree, std::uint32_t link, const SpecPoint& p) {
  double sum = 0;
  for (const SpecTriangle& triangle : tree.triangles(link)) {
    const SpecPoint a = minus(triangle.corners[0], p), b = minus(triangle.corners[1], p),
                    c = minus(triangle.corners[2], p);
    const double la = length(a), lb = length(b), lc = length(c);
    sum += 2 * std::atan2(dot(a, cross(b, c)),
                          la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
  }
  return sum / (4 * std::numbers::pi);
}

template <class Look>
void each_child(const SpecTree& tree, Look look) {
  for (const SpecPage& page : tree.pages())
    for (const auto& [link, node] : page.nodes)
      for (const SpecChild& child : node.children) look(child);
}

SpecTree open_sample() {
  for (const Sample& sample : samples()) {
    SpecTree tree{SpecFile(read_file(sample.ptree_path()))};
    if (tree.header().open && tree.header().node_count > 0) return tree;
  }
  throw std::runtime_error("no sample has moments");
}

TEST(SpecMoments, MatchTheTriangles) {
  const SpecTree tree = open_sample();
  each_child(tree, [&](const SpecChild& child) {
    const Integrals exact = integrate(tree, child);
    const SpecMoments& stored = child.moments;
    EXPECT_GE(stored.area, exact.area);
    EXPECT_LE(stored.area, exact.area * 1.01);
    EXPECT_GE(stored.second, exact.second);
    EXPECT_LE(stored.second, exact.second * 1.01);
    EXPECT_LE(length(minus(stored.vector, exact.vector)), 0x1p-15 * stored.area);
    EXPECT_LE(off(stored.first, exact.first), 1.75 * std::sqrt(stored.area * stored.second) / 127);
  });
}

TEST(SpecMoments, GiveSharesOfWindingNumbers) {
  const SpecTree tree = open_sample();
  std::mt19937_64 random(7);
  const auto coordinate = [&] { return static_cast<double>(random() >> 11) * 0x1p-51 - 2; };
  int certain = 0;
  for (int i = 0; i < 200; ++i) {
    const SpecPoint p = {coordinate(), coordinate(), coordinate()};
    each_child(tree, [&](const SpecChild& child) {
      const auto [value, error] = far(tree, child, p);
      EXPECT_LE(std::fabs(value - winding(tree, child.link, p)), error + 1e-14);
      certain += error < 0.01;
    });
  }
  EXPECT_GT(certain, 200);
}

TEST(SpecMoments, AreOnlyInFilesOfOpenSurfaces) {
  for (const Sample& sample : samples()) {
    const SpecTree tree{SpecFile(read_file(sample.ptree_path()))};
    each_child(tree, [&](const SpecChild& child) {
      EXPECT_EQ(child.moments.area > 0, tree.header().open);
    });
  }
}

}  // namespace
}  // namespace planetree::golden
