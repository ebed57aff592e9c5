#include "octree/builder/mask/prism_filter.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <vector>

#include "octree/nearest/height_field.h"
#include "tests/octree/support/each_block.h"
#include "tests/octree/support/each_target.h"
#include "tests/octree/support/sample_mask.h"

namespace planetree::octree {
namespace {

/// A prism in doubles with any rotation, and its conversion to float.
struct TestPrism {
  Point origin = Point::Zero();
  Eigen::Matrix3d rotated = Eigen::Matrix3d::Identity();
  Point lower = Point::Zero(), upper = Point::Zero();
  double clear = 0;

  FloatPrism in_float() const {
    FloatPrism prism;
    for (int row = 0; row < 3; ++row) {
      const auto at = static_cast<std::size_t>(row);
      for (int k = 0; k < 3; ++k)
        prism.rotated[at][static_cast<std::size_t>(k)] = static_cast<float>(rotated(row, k));
      prism.lower[at] = static_cast<float>(lower[row]);
      prism.upper[at] = static_cast<float>(upper[row]);
    }
    prism.clear = static_cast<float>(clear);
    prism.middle = {static_cast<float>(middle(0)), static_cast<float>(middle(1))};
    return prism;
  }
  double middle(int axis) const { return (lower[axis] + upper[axis]) / 2; }
};

/// A prism of about `size`, upright on one of the triangles or rotated at random.
TestPrism random_prism(Noise& noise, const Triangle& near, double size) {
  TestPrism prism;
  prism.origin = near[noise.bits() % 3];
  Point axis = (near[1] - near[0]).cross(near[2] - near[0]);
  if (!(axis.norm() > 0) || noise.bits() % 4 == 0)
    axis = Point(noise.uniform(-1, 1), noise.uniform(-1, 1), noise.uniform(0.1, 1));
  const Point across = axis.unitOrthogonal();
  prism.rotated.row(0) = across;
  prism.rotated.row(1) = axis.normalized().cross(across);
  prism.rotated.row(2) = axis.normalized();
  for (int k = 0; k < 3; ++k) {
    prism.lower[k] = -size * noise.uniform(0, 2);
    prism.upper[k] = size * noise.uniform(0, 2);
  }
  prism.clear = noise.bits() % 2 == 0 ? 0 : size * noise.uniform(0, 0.2);
  return prism;
}

/// Moves some sides of the prism, or its middle, to a corner, exactly in double.
void bring_to(const Point& corner, Noise& noise, TestPrism& prism) {
  const Point at = prism.rotated * (corner - prism.origin);
  for (int k = 0; k < 3; ++k) switch (noise.bits() % 8) {
      case 0:
        prism.lower[k] = at[k];
        prism.upper[k] = std::max(prism.upper[k], at[k]);
        break;
      case 1:
        prism.upper[k] = at[k];
        prism.lower[k] = std::min(prism.lower[k], at[k]);
        break;
      case 2:
        prism.lower[k] = at[k] - (prism.upper[k] - prism.lower[k]) / 2;
        prism.upper[k] = at[k] + (at[k] - prism.lower[k]);
        break;
      default:
        break;
    }
}

/// The expected results, computed in double. Its rounding is negligible beside that of float,
/// except where boxes barely touch.
struct DoubleTest {
  bool met = false, middle = false, may_rise = false;

  DoubleTest(const TestPrism& prism, const Triangle& triangle) {
    Triangle at;
    for (std::size_t k = 0; k < 3; ++k) at[k] = prism.rotated * (triangle[k] - prism.origin);
    const Point least = at[0].cwiseMin(at[1]).cwiseMin(at[2]);
    const Point greatest = at[0].cwiseMax(at[1]).cwiseMax(at[2]);
    met = (least.array() <= prism.upper.array()).all() &&
          (greatest.array() >= prism.lower.array()).all();
    middle = true;
    for (int k = 0; k < 2; ++k)
      middle = middle && least[k] <= prism.middle(k) && greatest[k] >= prism.middle(k);
    const Point u = at[1] - at[0], v = at[2] - at[0], w = at[2] - at[1];
    const Point normal = u.cross(v);
    std::array<double, 3> sides{u.norm(), v.norm(), w.norm()};
    std::sort(sides.begin(), sides.end());
    may_rise = greatest.z() < prism.upper.z() - prism.clear &&
               least.z() > prism.lower.z() + prism.clear &&
               normal.z() > HeightField::kMinRise * normal.norm() &&
               normal.norm() > HeightField::kMinSine * sides[1] * sides[2] &&
               sides[0] > 0x1p-24 * std::hypot(at[0].norm(), sides[2]);
  }
};

struct FilterCounts {
  std::size_t triangles = 0, met = 0, rising = 0, middle = 0;  // counted by the filter
  std::size_t truly_met = 0, truly_rising = 0, truly_middle = 0;
};

double reach_of(const BlockView& block) {
  double reach = 0;
  for (unsigned i = 1; i < block.header().vertex_count(); ++i)
    reach = std::max(reach, (block.vertex(i) - block.vertex(0)).norm());
  return reach;
}

FilterCounts expect_conservative(const Soup& soup) {
  const SampleTree sample = build_sample(soup);
  const SamplePages pages(sample);
  Noise noise(5);
  FilterCounts counts;
  each_block(sample, pages, [&](const BlockView& block, std::uint32_t) {
    for (int k = 0; k < 20 && !testing::Test::HasFailure(); ++k) {
      const double size = reach_of(block) * std::ldexp(1, 2 - static_cast<int>(noise.bits() % 8));
      const Triangle near = block.triangle(noise.bits() % block.triangle_count());
      TestPrism prism = random_prism(noise, near, size);
      bring_to(block.vertex(noise.bits() % block.header().vertex_count()), noise, prism);
      const PrismTriangles found = classify_triangles(block, prism.in_float(), prism.origin);
      EXPECT_EQ((found.met | found.rising | found.middle) >> block.triangle_count(), 0u);
      for (unsigned i = 0; i < block.triangle_count(); ++i) {
        const DoubleTest truth(prism, block.triangle(i));
        const bool met = found.met >> i & 1, rising = found.rising >> i & 1,
                   middle = found.middle >> i & 1;
        EXPECT_TRUE(met || !truth.met);
        EXPECT_TRUE(middle || !truth.middle);
        EXPECT_TRUE(!rising || truth.may_rise);
        ++counts.triangles;
        counts.met += met;
        counts.rising += rising;
        counts.middle += middle;
        counts.truly_met += truth.met;
        counts.truly_rising += truth.may_rise;
        counts.truly_middle += truth.middle;
      }
    }
  });
  return counts;
}

Soup thinned(Soup soup, double factor) {
  for (auto& triangle : soup)
    for (Vec3& p : triangle) p = {p.x * factor, p.y * factor, p.z};
  return soup;
}

// The filter agrees with double on nearly all triangles, so that few are tested twice.
TEST(PrismFilter, AgreesWithDouble) {
  for (const Soup& soup :
       {sphere(4), translated(sphere(4), {0.1, 0.7, -0.3}), scattered(1000, 0.1)}) {
    const FilterCounts counts = expect_conservative(soup);
    EXPECT_GT(counts.triangles, 10000u);
    EXPECT_LE(counts.met, counts.truly_met + counts.triangles / 100);
    EXPECT_LE(counts.middle, counts.truly_middle + counts.triangles / 100);
    EXPECT_LT(counts.truly_met, counts.triangles * 9 / 10);
    EXPECT_GT(counts.truly_rising, counts.triangles / 20);
    EXPECT_GT(counts.rising, counts.truly_rising * 9 / 10);
  }
}

TEST(PrismFilter, IsConservativeForNeedles) {
  for (const double factor : {0x1p-8, 0x1p-11, 0x1p-12, 0x1p-13, 0x1p-24, 0x1p-45})
    for (const Soup& soup : {scattered(300, 0.5), sphere(3)})
      EXPECT_GT(expect_conservative(thinned(soup, factor)).truly_met, 0u);
}

// Triangles so small beside their block that float hardly resolves their normals.
TEST(PrismFilter, IsConservativeForTinyTriangles) {
  for (const double size : {0x1p-10, 0x1p-14, 0x1p-17, 0x1p-19, 0x1p-21, 0x1p-23})
    EXPECT_GT(expect_conservative(scattered(700, size)).truly_rising, 0u);
}

// Blocks small beside their coordinates, and blocks small in themselves.
TEST(PrismFilter, IsConservativeForTinyAndFarBlocks) {
  const Soup whole = sphere(1);
  for (const double size : {0x1p-12, 0x1p-25, 0x1p-45, 0x1p-90}) {
    const Soup tiny = scaled(scattered(300, 0.2), size);
    EXPECT_GT(expect_conservative(joined({tiny, whole})).truly_met, 0u);
    EXPECT_GT(expect_conservative(joined({translated(tiny, {0.7, 0.1, 0.3}), whole})).truly_met,
              0u);
  }
  for (const double by : {0x1p6, 0x1p15})
    EXPECT_GT(expect_conservative(translated(sphere(4), {by, -by, 0})).truly_rising, 0u);
}

// Prisms far from the block.
TEST(PrismFilter, IsConservativeForOtherBlocks) {
  const SampleTree sample = build_sample(scattered(1000, 0.3));
  const SamplePages pages(sample);
  std::vector<BlockView> blocks;
  each_block(sample, pages,
             [&](const BlockView& block, std::uint32_t) { blocks.push_back(block); });
  Noise noise(6);
  std::size_t met = 0;
  for (const BlockView& block : blocks)
    for (int k = 0; k < 20; ++k) {
      const BlockView& other = blocks[noise.bits() % blocks.size()];
      const TestPrism prism = random_prism(noise, other.triangle(0),
                                           std::ldexp(1, -static_cast<int>(noise.bits() % 6)));
      const PrismTriangles found = classify_triangles(block, prism.in_float(), prism.origin);
      for (unsigned i = 0; i < block.triangle_count(); ++i) {
        const DoubleTest truth(prism, block.triangle(i));
        EXPECT_TRUE((found.met >> i & 1) != 0 || !truth.met);
        EXPECT_TRUE((found.middle >> i & 1) != 0 || !truth.middle);
        EXPECT_TRUE((found.rising >> i & 1) == 0 || truth.may_rise);
        met += truth.met;
      }
    }
  EXPECT_GT(met, 1000u);
}

TEST(PrismFilter, GivesTheSameResultOnEveryInstructionSet) {
  for (const Soup& soup : {sphere(4), scattered(900, 0.1), thinned(scattered(300, 0.5), 0x1p-12)}) {
    const SampleTree sample = build_sample(soup);
    const SamplePages pages(sample);
    const auto counts = on_each_target([&] {
      Noise noise(7);
      std::vector<std::tuple<unsigned, unsigned, unsigned>> bits;
      each_block(sample, pages, [&](const BlockView& block, std::uint32_t) {
        const TestPrism prism = random_prism(noise, block.triangle(0), reach_of(block) / 2);
        const PrismTriangles found = classify_triangles(block, prism.in_float(), prism.origin);
        bits.emplace_back(found.met, found.rising, found.middle);
      });
      return bits;
    });
    ASSERT_GT(counts.size(), 1u);
    for (const auto& bits : counts) EXPECT_EQ(bits == counts[0], true);
  }
}

}  // namespace
}  // namespace planetree::octree
