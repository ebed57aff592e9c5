#include "tests/oracle/closed_models.h"

#include <cmath>

#include "tests/octree/support/divided_octahedron.h"

namespace planetree::oracle {
namespace {

Vec3 on_lattice(Random& random, std::size_t steps) {
  const auto coordinate = [&] {
    return static_cast<double>(random.below(steps + 1)) / static_cast<double>(steps);
  };
  return {coordinate(), coordinate(), coordinate()};
}

template <class MakePoint>
Soup tetrahedra(std::size_t count, const MakePoint& make_point) {
  Soup soup;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 a = make_point(), b = make_point(), c = make_point(), d = make_point();
    soup = soup + tetrahedron(a, b, c, d);
  }
  return soup;
}

// Of any size and orientation, intersecting each other.
Soup overlapping(Random& random) {
  return tetrahedra(20, [&] { return random.in_cube(); });
}

// Many flat ones, with faces in one plane and edges through corners.
Soup lattice_tetrahedra(Random& random) {
  return tetrahedra(60, [&] { return on_lattice(random, 4); });
}

Soup lattice_boxes(Random& random) {
  Soup soup;
  for (int i = 0; i < 25; ++i) {
    const Vec3 lower = on_lattice(random, 4);
    const Soup one = box(lower, lower + Vec3{0.25, 0.25, 0.5} * double(1 + random.below(3)));
    soup = soup + (random.one_in(3) ? inside_out(one) : one);
  }
  return soup;
}

Soup slivers(Random& random) {
  const Vec3 along = random.in_cube();
  return tetrahedra(30, [&] {
    const Vec3 at = along * random.either_sign();
    return at + random.in_some_cube(-40, -10);
  });
}

Soup scales(Random& random) {
  return tetrahedra(30, [&] { return random.in_some_cube(-30, 0); });
}

Soup nested_balls(Random& random) {
  const double gap = random.magnitude(-50, -1);
  return ball(1) + scaled(inside_out(ball(1)), 1 - gap) + scaled(ball(0), 0.5);
}

Soup rotated_ball(Random& random) {
  const auto [c, s] = on_circle(random.unit());
  Soup soup = ball(2);
  for (Corners& triangle : soup)
    for (Vec3& p : triangle) p = {c * p.x - s * p.y, s * p.x + c * p.y, p.z + 0.1 * p.x};
  return soup;
}

// As far from the origin, and as small, as details in map coordinates.
Soup far_away(Random& random) {
  return translated(tetrahedra(20, [&] { return random.in_cube() * 0x1p-16; }), {1, -0.75, 0.5});
}

Vec3 on_sphere(const Vec3& a, const Vec3& b) {
  const Vec3 sum = a + b;
  return sum * (1 / std::sqrt(sum.x * sum.x + sum.y * sum.y + sum.z * sum.z));
}

constexpr NastyFamily kFamilies[] = {
    {"overlapping", overlapping},
    {"lattice tetrahedra", lattice_tetrahedra},
    {"lattice boxes", lattice_boxes},
    {"slivers", slivers},
    {"scales", scales},
    {"nested balls", nested_balls},
    {"rotated ball", rotated_ball},
    {"far away", far_away},
};

}  // namespace

Soup operator+(Soup left, const Soup& right) {
  left.insert(left.end(), right.begin(), right.end());
  return left;
}

Soup inside_out(Soup triangles) {
  for (Corners& triangle : triangles) std::swap(triangle[1], triangle[2]);
  return triangles;
}

Soup tetrahedron(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  return {{a, b, c}, {a, d, b}, {b, d, c}, {c, d, a}};
}

Soup box(const Vec3& lower, const Vec3& upper) {
  const auto corner = [&](unsigned i) {
    return Vec3{i & 1 ? upper.x : lower.x, i & 2 ? upper.y : lower.y, i & 4 ? upper.z : lower.z};
  };
  constexpr unsigned kFaces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                     {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  Soup soup;
  for (const auto& f : kFaces) {
    soup.push_back({corner(f[0]), corner(f[1]), corner(f[2])});
    soup.push_back({corner(f[0]), corner(f[2]), corner(f[3])});
  }
  return soup;
}

Soup ball(unsigned levels) { return octree::DividedOctahedron(levels, on_sphere).faces(); }

std::span<const NastyFamily> closed_families() { return kFamilies; }

}  // namespace planetree::oracle
