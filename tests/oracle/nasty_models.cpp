#include "tests/oracle/nasty_models.h"

#include <cmath>
#include <limits>

namespace planetree::oracle {
namespace {

struct Axes {
  Vec3 x, y, z;
};

double length(const Vec3& a) { return std::sqrt(a.x * a.x + a.y * a.y + a.z * a.z); }
Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

Axes random_axes(Random& random) {
  const Vec3 along = random.in_cube();
  const Vec3 x = along * (1 / length(along));
  const Vec3 aside = cross(x, random.in_cube());
  const Vec3 y = aside * (1 / length(aside));
  return {x, y, cross(x, y)};
}

// A triangle with one long edge, and a corner at `height` above `point` of its length.
Corners slender(Random& random, double height, double point) {
  const Axes axes = random_axes(random);
  const Vec3 start = random.in_cube();
  Corners triangle{start, start + axes.x, start + axes.x * point + axes.y * height};
  std::swap(triangle[random.below(3)], triangle[0]);
  return triangle;
}

Soup repeat(std::size_t count, Random& random, Corners (*make)(Random&)) {
  Soup soup;
  for (std::size_t i = 0; i < count; ++i) soup.push_back(make(random));
  return soup;
}

Soup soup(Random& random) {
  return repeat(1 + random.below(300), random, [](Random& r) {
    const double size = r.magnitude(-8, 0);
    const Vec3 at = r.in_cube();
    return Corners{at + r.in_cube() * size, at + r.in_cube() * size, at + r.in_cube() * size};
  });
}

Soup needles(Random& random) {
  return repeat(1 + random.below(100), random, [](Random& r) {
    const double height = r.magnitude(-60, -5);
    return slender(r, height, r.one_in(2) ? 0 : 1);
  });
}

Soup caps(Random& random) {
  return repeat(1 + random.below(100), random, [](Random& r) {
    const double height = r.magnitude(-60, -3);
    return slender(r, height, r.between(0.1, 0.9));
  });
}

// Angles near the thresholds at which the library changes its method: sines of 2^-4, 2^-5 and
// 2^-50.
Soup thresholds(Random& random) {
  return repeat(1 + random.below(100), random, [](Random& r) {
    constexpr double kSines[] = {0x1p-4, 0x1p-5, 0x1p-50};
    const double about = kSines[r.below(3)];
    const double sine = about * (1 + r.signed_magnitude(-40, -3));
    const double point = r.one_in(3) ? r.magnitude(-20, 0) : 0.5;
    return slender(r, sine * point, point);
  });
}

Soup fan(Random& random) {
  const std::size_t count = 3 + random.below(400);
  const Axes axes = random_axes(random);
  const double rise = random.one_in(2) ? 0 : random.magnitude(-30, 1);
  const auto rim = [&](std::size_t i) {
    const auto [x, y] = on_circle(static_cast<double>(i % count) / static_cast<double>(count));
    return axes.x * x + axes.y * y;
  };
  Soup triangles;
  for (std::size_t i = 0; i < count; ++i) triangles.push_back({axes.z * rise, rim(i), rim(i + 1)});
  return triangles;
}

// Copies of few triangles, some with their corners in another order, some shifted by a tiny amount.
Soup layers(Random& random) {
  const Soup few = soup(random);
  Soup triangles;
  const std::size_t count = 20 + random.below(300);
  for (std::size_t i = 0; i < count; ++i) {
    Corners triangle = few[random.below(std::min<std::size_t>(few.size(), 7))];
    if (random.one_in(2)) std::swap(triangle[random.below(3)], triangle[0]);
    if (random.one_in(3)) {
      const Vec3 shift = random.in_some_cube(-56, -40);
      for (Vec3& corner : triangle) corner = corner + shift;
    }
    triangles.push_back(triangle);
  }
  return triangles;
}

Soup degenerates(Random& random) {
  return repeat(2 + random.below(200), random, [](Random& r) {
    const Vec3 a = r.in_cube(), b = a + r.in_some_cube(-50, 0);
    const double third[] = {0, 0.5, 1, 2, 0.25};
    switch (r.below(4)) {
      case 0:
        return Corners{a, a, a};
      case 1:
        return Corners{a, b, a};
      case 2:
        return Corners{a, b, a + (b - a) * third[r.below(5)]};
      default:
        return Corners{a, b, r.in_cube()};
    }
  });
}

// Triangles of sizes from very small to very large about one point.
Soup mixed_scales(Random& random) {
  Soup triangles;
  const Vec3 point = random.in_cube();
  const double least = random.one_in(2) ? -60 : random.between(-250, -20);
  for (std::size_t i = 5 + random.below(200); i > 0; --i) {
    const double size = random.magnitude(least, 0);
    const Vec3 aside = random.in_cube() * size;
    const Vec3 at = random.one_in(3) ? point : point + aside;
    triangles.push_back({at, at + random.in_cube() * size, at + random.in_cube() * size});
  }
  return triangles;
}

// A grid in the plane z = 0, or one with tiny steps.
Soup grid(Random& random) {
  const std::size_t side = 1 + random.below(14);
  const double step = random.one_in(2) ? 0 : random.magnitude(-50, -5);
  const auto at = [&](std::size_t i, std::size_t j) {
    return Vec3{static_cast<double>(i), static_cast<double>(j),
                step * static_cast<double>((i * 7 + j * 3) % 5)};
  };
  Soup triangles;
  for (std::size_t i = 0; i < side; ++i)
    for (std::size_t j = 0; j < side; ++j) {
      triangles.push_back({at(i, j), at(i + 1, j), at(i, j + 1)});
      triangles.push_back({at(i + 1, j + 1), at(i, j + 1), at(i + 1, j)});
    }
  return scaled(triangles, 1.0 / 16);
}

// Small triangles far from the origin, where few bits are left.
Soup map_coordinates(Random& random) {
  const double distance = random.magnitude(5, 45);
  const Soup near = soup(random);
  return translated(near, random.in_cube() * distance);
}

// Triangles that all share one corner.
Soup many_at_a_corner(Random& random) {
  Soup triangles;
  const Vec3 corner = random.in_cube();
  for (std::size_t i = 1 + random.below(200); i > 0; --i)
    triangles.push_back({random.in_cube(), corner, random.in_cube()});
  return triangles;
}

constexpr NastyFamily kFamilies[] = {
    {"soup", soup},
    {"needles", needles},
    {"caps", caps},
    {"thresholds", thresholds},
    {"fan", fan},
    {"layers", layers},
    {"degenerates", degenerates},
    {"mixed scales", mixed_scales},
    {"grid", grid},
    {"map coordinates", map_coordinates},
    {"many at a corner", many_at_a_corner},
};

}  // namespace

std::span<const NastyFamily> nasty_families() { return kFamilies; }

double one_ulp_off(Random& random, double value) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  switch (random.below(3)) {
    case 0:
      return std::nextafter(value, kInfinity);
    case 1:
      return std::nextafter(value, -kInfinity);
    default:
      return value;
  }
}

Vec3 operator+(const Vec3& a, const Vec3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
Vec3 operator-(const Vec3& a, const Vec3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Vec3 operator*(const Vec3& a, double factor) { return {a.x * factor, a.y * factor, a.z * factor}; }

std::array<double, 2> on_circle(double turn) {
  const double quarters = 4 * turn, whole = std::floor(quarters), t = quarters - whole;
  const double x = (1 - t * t) / (1 + t * t), y = 2 * t / (1 + t * t);
  switch (static_cast<int>(whole) & 3) {
    case 0:
      return {x, y};
    case 1:
      return {-y, x};
    case 2:
      return {-x, -y};
    default:
      return {y, -x};
  }
}

Soup scaled(Soup triangles, double factor) {
  for (Corners& triangle : triangles)
    for (Vec3& corner : triangle) corner = corner * factor;
  return triangles;
}

Soup translated(Soup triangles, const Vec3& offset) {
  for (Corners& triangle : triangles)
    for (Vec3& corner : triangle) corner = corner + offset;
  return triangles;
}

Vec3 point_on(Random& random, const Corners& triangle) {
  double v = random.unit(), w = random.unit();
  if (v + w > 1 && !random.one_in(8)) {
    v = 1 - v;
    w = 1 - w;
  }
  if (random.one_in(8)) w = 0;
  return triangle[0] + (triangle[1] - triangle[0]) * v + (triangle[2] - triangle[0]) * w;
}

Vec3 nasty_query(Random& random, std::span<const Corners> triangles, double size) {
  const Corners& triangle = triangles[random.below(triangles.size())];
  const Vec3& corner = triangle[random.below(3)];
  switch (random.below(7)) {
    case 0:
      return corner;
    case 1:
      return {one_ulp_off(random, corner.x), one_ulp_off(random, corner.y),
              one_ulp_off(random, corner.z)};
    case 2:
      return (triangle[0] + triangle[1]) * 0.5;
    case 3:
      return corner + random.in_some_cube(0, 50) * size;
    case 4:
      return corner + random.in_cube() * size;
    case 5:
      return point_on(random, triangle);
    default: {
      const Vec3 on = point_on(random, triangle);
      return on + random.in_some_cube(-60, 0) * size;
    }
  }
}

}  // namespace planetree::oracle
