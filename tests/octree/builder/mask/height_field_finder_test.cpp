#include "octree/builder/mask/height_field_finder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "tests/octree/support/each_target.h"
#include "tests/octree/support/exact_overlap.h"
#include "tests/octree/support/height_field_model.h"

namespace planetree::octree {
namespace {

struct Marks {
  std::size_t blocks = 0, marked = 0;
  TraversalStats work;
  double share() const { return static_cast<double>(marked) / static_cast<double>(blocks); }
};

using BlockCall = std::function<void(const BlockView&, bool marked)>;

Marks each_mark(const HeightFieldModel& model, const BlockCall& look) {
  TreeFrames frames(model.tree.tree.get(), &model.mask);
  const HeightFieldFinder finder(model.info, model.mask_info);
  Marks marks;
  model.each_block([&](const BlockView& block, std::uint32_t) {
    const bool marked = finder.is_height_field(block, frames.reader(), marks.work);
    ++marks.blocks;
    marks.marked += marked;
    look(block, marked);
  });
  EXPECT_TRUE(frames.state());
  return marks;
}

// Expects the outside just in front of a triangle and the inside just behind it, at its middle or
// near a corner.
void expect_sides(const Surface& surface, const Triangle& triangle, bool middle) {
  const auto& [a, b, c] = triangle;
  const Point normal = (b - a).cross(c - a);
  ASSERT_GT(normal.norm(), 0);
  const Point point = middle ? Point((a + b + c) / 3) : Point(0.98 * a + 0.01 * b + 0.01 * c);
  for (const double by : {0x1p-31, -0x1p-31})
    EXPECT_EQ(surface.winding(point + by * normal.normalized()), by > 0 ? 0 : 1);
}

// Expects each marked block to be a height field. Returns the number of marks.
Marks expect_true_marks(const HeightFieldModel& model) {
  return each_mark(model, [&](const BlockView& block, bool marked) {
    if (!marked || testing::Test::HasFailure()) return;
    for (unsigned i = 0; i < block.triangle_count(); ++i)
      expect_sides(model.surface, block.triangle(i), i % 2 == 0);
  });
}

Marks expect_true_marks(const Soup& soup) { return expect_true_marks(HeightFieldModel(soup)); }

// Scales x between `from` and `to` by `part`, and translates what is beyond.
Soup squeezed(Soup soup, double from, double to, double part) {
  for (auto& triangle : soup)
    for (Vec3& p : triangle)
      p.x = p.x <= from ? p.x
            : p.x < to  ? from + (p.x - from) * part
                        : p.x - (to - from) * (1 - part);
  return soup;
}

TEST(HeightFieldFinder, FindsMostOfASphere) {
  const Marks marks = expect_true_marks(sphere(5));
  EXPECT_GT(marks.blocks, 500u);
  EXPECT_GT(marks.share(), 0.95);
}

TEST(HeightFieldFinder, FindsMostOfASphereInDoubles) {
  const HeightFieldModel model(translated(sphere(5), {0.1, 0.7, -0.3}));
  ASSERT_TRUE(model.info.shape.float64);
  EXPECT_GT(expect_true_marks(model).share(), 0.95);
}

TEST(HeightFieldFinder, FindsNoneOnInvertedSurfaces) {
  EXPECT_EQ(expect_true_marks(inside_out(sphere(4))).marked, 0u);
}

// Where one sphere is inside the other, the winding number is 2 behind its surface and 1 in front.
TEST(HeightFieldFinder, FindsNoneWithinAnotherSolid) {
  const HeightFieldModel model(joined({sphere(5), translated(sphere(5), {0.9, 0, 0})}));
  const Marks marks = expect_true_marks(model);
  EXPECT_GT(marks.share(), 0.4);
  EXPECT_LT(marks.share(), 0.7);
}

// Nested surfaces: the number rises by one behind each of them, and falls behind an inverted one.
TEST(HeightFieldFinder, FindsTheWallsOfHollowSolids) {
  const Marks hollow = expect_true_marks(joined({sphere(5), inside_out(scaled(sphere(5), 0.5))}));
  EXPECT_GT(hollow.share(), 0.9);
  const Marks nested = expect_true_marks(joined({sphere(5), scaled(sphere(5), 0.5)}));
  EXPECT_GT(nested.share(), 0.4);
  EXPECT_LT(nested.share(), 0.55);
}

TEST(HeightFieldFinder, FindsNoneWhereLayersAreNear) {
  EXPECT_EQ(expect_true_marks(shells(3)).marked, 0u);
  EXPECT_EQ(expect_true_marks(copies(sphere(3), 2)).marked, 0u);
}

// Blocks at the rim may be height fields, unless the plate is so thin that they hold needles.
TEST(HeightFieldFinder, FindsNoneOnTheFacesOfAThinPlate) {
  for (const double thickness : {0.0, 0x1p-40, 0x1p-20, 0.001}) {
    const HeightFieldModel model(box({0, 0, 0}, {1, 1, thickness}, 20));
    std::size_t on_faces = 0;
    const Marks marks = each_mark(model, [&](const BlockView& block, bool marked) {
      const Triangle first = block.triangle(0);
      if (first[0].z() != first[1].z() || first[0].z() != first[2].z()) return;
      ++on_faces;
      EXPECT_FALSE(marked) << thickness;
    });
    EXPECT_GT(on_faces, 50u);
    EXPECT_EQ(marks.marked > 0, thickness == 0.001);
    expect_true_marks(model);
  }
}

// All blocks of a face but those along its edges, where neighbouring faces do not rise in the same
// direction.
TEST(HeightFieldFinder, FindsTheFacesOfABox) {
  EXPECT_GT(expect_true_marks(box({0, 0, 0}, {1, 1.3, 1.6}, 32)).share(), 0.6);
  // The whole box is one block.
  EXPECT_EQ(expect_true_marks(box({0, 0, 0}, {1, 1, 1})).marked, 0u);
}

TEST(HeightFieldFinder, FindsNoneWithNeedlesOrTrianglesOfNoArea) {
  const Soup even = box({0, 0, 0}, {1, 1, 1}, 32);
  for (const double part : {0.0, 0x1p-30, 0x1p-15}) {
    const double upper = 0.5 + 0x1p-5 * part;
    const HeightFieldModel model(squeezed(even, 0.5, 0.53125, part));
    const Marks marks = each_mark(model, [&](const BlockView& block, bool marked) {
      bool left = false, right = false;
      for (unsigned i = 0; i < block.header().vertex_count(); ++i) {
        left = left || block.vertex(i).x() <= upper;
        right = right || block.vertex(i).x() >= 0.5;
      }
      EXPECT_FALSE(marked && left && right) << part;
    });
    EXPECT_GT(marks.share(), 0.5);
  }
  EXPECT_GT(expect_true_marks(squeezed(even, 0.5, 0.53125, 0x1p-5)).share(), 0.5);
}

// Another solid touches the surface with a vertex. It is as small as the prism, or reaches beyond
// it.
TEST(HeightFieldFinder, FindsNoneTouchedByAnotherSolid) {
  const Vec3 tip{1, 0.40625, 0.453125};
  const Soup solid = box({0, 0, 0}, {1, 1, 1}, 16);
  const Point at(tip.x, tip.y, tip.z);
  for (const double height : {0.0, 0.1, 0.7}) {
    const double x = 1 + height;
    const Vec3 a{x, 0.4, 0.4}, b{x, 0.5, 0.4}, c{x, 0.45, 0.5};
    const Soup other = {{tip, b, a}, {tip, c, b}, {tip, a, c}, {a, b, c}};
    const HeightFieldModel model(height > 0 ? joined({solid, other}) : solid);
    ASSERT_EQ(model.tree.mesh.upper().x(), x);
    std::size_t there = 0;
    expect_true_marks(model);
    each_mark(model, [&](const BlockView& block, bool marked) {
      bool holds = false;
      for (unsigned i = 0; i < block.triangle_count(); ++i)
        holds = holds || exactly_touches(block.triangle(i), at, at);
      there += holds;
      EXPECT_TRUE(!holds || marked == (height == 0)) << height;
    });
    EXPECT_GT(there, 0u);
  }
}

TEST(HeightFieldFinder, FindsNoneTooFarFromTheOrigin) {
  EXPECT_GT(expect_true_marks(translated(sphere(4), {0x1p10, 0, 0})).share(), 0.9);
  for (const Vec3& by : {Vec3{0x1p20, 0, 0}, Vec3{0, 0, -0x1p20}})
    EXPECT_EQ(expect_true_marks(translated(sphere(4), by)).marked, 0u);
}

TEST(HeightFieldFinder, FindsNoneWhereAPageIsMissing) {
  const HeightFieldModel model(sphere(4));
  const HeightFieldFinder finder(model.info, model.mask_info);
  TreeFrames frames(model.tree.tree.get(), &model.mask);
  struct Withholding {
    PageReader pages;
    std::uint32_t from, to;
  };
  const auto count = [&](std::uint32_t from, std::uint32_t to) {
    Withholding some{frames.reader(), from, to};
    const PageReader reader{&some, [](void* context, std::uint32_t page) noexcept {
                              const auto& self = *static_cast<Withholding*>(context);
                              const bool held = self.from <= page && page < self.to;
                              return held ? nullptr : self.pages.page(self.pages.context, page);
                            }};
    std::size_t marked = 0;
    TraversalStats work;
    model.each_block([&](const BlockView& block, std::uint32_t) {
      marked += finder.is_height_field(block, reader, work);
    });
    return marked;
  };
  const std::uint32_t first_mask_page = model.mask_info.first_page;
  const std::size_t all = count(0, 0);
  EXPECT_GT(all, 0u);
  EXPECT_LT(count(first_mask_page - 1, first_mask_page), all);
  EXPECT_LT(count(first_mask_page, first_mask_page + model.mask.size()), all);
  EXPECT_EQ(count(0, first_mask_page), 0u);
}

// The file's bytes depend on the marks.
TEST(HeightFieldFinder, FindsTheSameOnEveryInstructionSet) {
  for (const Soup& soup : {joined({sphere(4), translated(sphere(4), {0.9f, 0.1f, 0.2f})}),
                           box({0, 0, 0}, {1, 1, 0.1}, 20), grains(200, 0.05)}) {
    const HeightFieldModel model(soup);
    const auto results = on_each_target([&] {
      std::vector<bool> marks;
      each_mark(model, [&](const BlockView&, bool marked) { marks.push_back(marked); });
      return marks;
    });
    ASSERT_FALSE(results.empty());
    for (const std::vector<bool>& marks : results) EXPECT_EQ(marks, results[0]);
  }
}

}  // namespace
}  // namespace planetree::octree
