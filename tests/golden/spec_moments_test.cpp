// Checks the moments that the specification states, and the share of a winding number computed from
// them, against every cap.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "tests/golden/samples.h"
#include "tests/golden/spec_sides.h"
#include "tests/golden/spec_tree.h"
#include "tests/golden/spec_vector.h"

namespace planetree::golden {
namespace {

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
    for (std::size_t k = 0; k < 3; ++k) e[k] = triangle.corners[k] - tree.header().centre - middle;
    SpecPoint half = cross(e[1] - e[0], e[2] - e[0]);
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

template <class Look>
void each_child(const SpecTree& tree, Look look) {
  for (const SpecPage& page : tree.pages())
    for (const auto& [link, node] : page.nodes)
      for (const SpecChild& child : node.children) look(child);
}

std::vector<SpecTree> caps_with_moments() {
  return {SpecTree(SpecFile(read_file(tube_sample().ptree_path())), SpecTree::Of::kCaps),
          SpecTree(SpecFile(build_loose_sphere()), SpecTree::Of::kCaps)};
}

TEST(SpecMoments, MatchTheCaps) {
  for (const SpecTree& tree : caps_with_moments()) {
    EXPECT_GT(tree.counts().nodes, 0u);
    each_child(tree, [&](const SpecChild& child) {
      const Integrals exact = integrate(tree, child);
      const SpecMoments& stored = child.moments;
      const double scale = std::sqrt(stored.area * stored.second);
      EXPECT_GE(stored.area, exact.area);
      EXPECT_LE(stored.area, exact.area * 1.01);
      EXPECT_GE(stored.second, exact.second);
      EXPECT_LE(stored.second, exact.second * 1.01);
      EXPECT_LE(length(stored.vector - exact.vector), 0x1p-15 * stored.area);
      EXPECT_LE(off(stored.first, exact.first), 1.75 * scale / 127);
    });
  }
}

TEST(SpecMoments, GiveSharesOfWindingNumbers) {
  std::mt19937_64 random(7);
  const auto coordinate = [&] { return static_cast<double>(random() >> 11) * 0x1p-51 - 2; };
  for (const SpecTree& tree : caps_with_moments()) {
    int certain = 0;
    for (int i = 0; i < 100; ++i) {
      const SpecPoint p = {coordinate(), coordinate(), coordinate()};
      each_child(tree, [&](const SpecChild& child) {
        const auto [value, error] = far(tree, child, p);
        EXPECT_LE(std::fabs(value - winding_number(tree.triangles(child.link), p)), error + 1e-14);
        certain += error < 0.01;
      });
    }
    EXPECT_GT(certain, 100);
  }
}

}  // namespace
}  // namespace planetree::golden
