#include <gtest/gtest.h>

#include <cstdint>

#include "tests/oracle/built_model.h"
#include "tests/oracle/closed_models.h"
#include "tests/oracle/random.h"
#include "tests/oracle/winding.h"

// Sides decided by the nearest faces, where these are in a height field.
namespace planetree::oracle {
namespace {

// A point above the middle of a face, at `height` times the face's normal.
Vec3 off_middle(const Corners& face, double height) {
  const auto [a, b, c] = face;
  const Vec3 u{b.x - a.x, b.y - a.y, b.z - a.z}, v{c.x - a.x, c.y - a.y, c.z - a.z};
  const Vec3 normal{u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x};
  return {(a.x + b.x + c.x) / 3 + height * normal.x, (a.y + b.y + c.y) / 3 + height * normal.y,
          (a.z + b.z + c.z) / 3 + height * normal.z};
}

class HeightFieldSides {
 public:
  explicit HeightFieldSides(const Soup& soup)
      : model_(soup, {.max_probes = 2}), other_(*Probe::create(model_.model())) {}

  // Share of the points off faces whose side needs no pages besides those of the distance, among
  // the points whose side the side grid does not give.
  double share_spared(double height) {
    unsigned queried = 0, spared = 0;
    for (const Corners& face : model_.triangles()) {
      const Vec3 query = off_middle(face, height);
      const std::uint64_t first = hits();
      (void)other_.contains(query);
      const std::uint64_t before = hits();
      const ClosestPoint distance = other_.closest_point(query, {.parts = kDistance});
      const std::uint64_t middle = hits();
      const ClosestPoint all = model_.closest_point(query);
      EXPECT_EQ(all.side, exact_side(query, model_.triangles()));
      EXPECT_EQ(all.distance, distance.distance);
      if (before == first) continue;
      ++queried;
      spared += hits() - middle == middle - before ? 1 : 0;
    }
    EXPECT_GT(queried, model_.triangles().size() / 2);
    return double{1} * spared / queried;
  }

 private:
  std::uint64_t hits() const { return model_.model().stats().page_hits; }

  BuiltModel model_;
  Probe other_;
};

TEST(HeightFieldSides, NeedNoPagesBesidesThoseOfDistances) {
  HeightFieldSides sides(ball(4));
  EXPECT_GT(sides.share_spared(0.3), 0.9);
  EXPECT_GT(sides.share_spared(-0.3), 0.9);
}

// If every inner point is inside twice, or the surface is inside out, no face decides a side by
// itself.
TEST(HeightFieldSides, AreComputedWhereFacesDoNotDecideThem) {
  for (const Soup& soup : {ball(4) + ball(4), inside_out(ball(4))}) {
    HeightFieldSides sides(soup);
    EXPECT_EQ(sides.share_spared(0.3), 0);
    EXPECT_EQ(sides.share_spared(-0.3), 0);
  }
}

}  // namespace
}  // namespace planetree::oracle
