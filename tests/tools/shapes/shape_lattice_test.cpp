#include "tools/shapes/shape_lattice.h"

#include <gtest/gtest.h>

#include <array>
#include <set>

namespace planetree::tools {
namespace {

TEST(CubeLattice, CountsEveryPointOfTheSurfaceOnce) {
  for (const std::uint64_t n : {1U, 2U, 3U, 8U}) {
    const CubeLattice lattice(n);
    std::set<std::array<std::uint64_t, 3>> points;
    std::uint64_t layer = 0;
    for (std::uint64_t index = 0; index < lattice.point_count(); ++index) {
      const LatticePoint p = lattice.point(index);
      EXPECT_TRUE(p.i <= n && p.j <= n && p.k <= n);
      EXPECT_TRUE(p.i % n == 0 || p.j % n == 0 || p.k % n == 0);
      EXPECT_GE(p.k, layer);
      layer = p.k;
      points.insert({p.i, p.j, p.k});
    }
    EXPECT_EQ(points.size(), (n + 1) * (n + 1) * (n + 1) - (n - 1) * (n - 1) * (n - 1));
  }
}

TEST(PillowLattice, HasOneRimAndTwoInteriors) {
  for (const std::uint64_t n : {2U, 4U, 10U}) {
    const PillowLattice lattice(n);
    std::uint64_t raised = 0, rim = 0;
    std::set<std::array<std::uint64_t, 3>> points;
    for (std::uint64_t index = 0; index < lattice.point_count(); ++index) {
      const LatticePoint p = lattice.point(index);
      EXPECT_TRUE(p.i <= n && p.j <= n);
      raised += p.k;
      rim += p.i % n == 0 || p.j % n == 0 ? 1 : 0;
      points.insert({p.i, p.j, p.k});
    }
    EXPECT_EQ(points.size(), lattice.point_count());
    EXPECT_EQ(raised, (n - 1) * (n - 1));
    EXPECT_EQ(rim, 4 * n);
  }
}

TEST(GridLattice, PutsNoTriangleOnTheRimAlone) {
  for (const std::uint64_t n : {2U, 3U, 4U, 7U}) {
    const GridLattice lattice(n);
    for (std::uint64_t t = 0; t < lattice.triangle_count(); ++t) {
      std::uint64_t inner = 0;
      for (const LatticePoint& p : lattice.triangle(t)) {
        inner += p.i % n != 0 && p.j % n != 0 ? 1 : 0;
      }
      EXPECT_GT(inner, 0U) << "n " << n << ", triangle " << t;
    }
  }
}

TEST(CentredCoordinate, IsExactAtTheEndsAndTheMiddle) {
  for (const std::uint64_t n : {1U, 2U, 3U, 10U, 26754U}) {
    EXPECT_EQ(centred_coordinate(0, n), -1);
    EXPECT_EQ(centred_coordinate(n, n), 1);
    if (n % 2 == 0) {
      EXPECT_EQ(centred_coordinate(n / 2, n), 0);
    }
  }
}

}  // namespace
}  // namespace planetree::tools
