#include "tests/octree/support/degenerate_meshes.h"

#include <algorithm>
#include <cmath>

namespace planetree::octree {
namespace {

using Face = std::array<std::uint32_t, 3>;

/// SplitMix64.
class Numbers {
 public:
  double between(double low, double high) {
    std::uint64_t z = state_ += 0x9e3779b97f4a7c15;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9;
    z = (z ^ z >> 27) * 0x94d049bb133111eb;
    return low + (high - low) * static_cast<double>((z ^ z >> 31) >> 11) * 0x1p-53;
  }
  Vec3 in_cube(double half = 1) {
    const double x = between(-half, half), y = between(-half, half), z = between(-half, half);
    return {x, y, z};
  }
  Vec3 on_sphere() {
    for (;;) {
      const Vec3 p = in_cube();
      const double squared = p.x * p.x + p.y * p.y + p.z * p.z;
      if (squared > 1 || squared < 0.01) continue;
      const double length = std::sqrt(squared);
      return {p.x / length, p.y / length, p.z / length};
    }
  }

 private:
  std::uint64_t state_ = 7;
};

Vec3 plus(const Vec3& a, const Vec3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }

double to_float(double value) { return static_cast<double>(static_cast<float>(value)); }

std::uint32_t add(IndexedMesh& mesh, const Vec3& p) {
  mesh.vertices.push_back({to_float(p.x), to_float(p.y), to_float(p.z)});
  return static_cast<std::uint32_t>(mesh.vertices.size() - 1);
}

void add_triangle(IndexedMesh& mesh, const Vec3& a, const Vec3& b, const Vec3& c) {
  const std::uint32_t i = add(mesh, a), j = add(mesh, b), k = add(mesh, c);
  mesh.triangles.push_back({i, j, k});
}

void add_tetrahedron(IndexedMesh& mesh, const std::array<Vec3, 4>& corners) {
  const std::uint32_t first = add(mesh, corners[0]);
  for (unsigned i = 1; i < 4; ++i) add(mesh, corners[i]);
  for (const Face& face : {Face{0, 2, 1}, Face{0, 1, 3}, Face{1, 2, 3}, Face{0, 3, 2}})
    mesh.triangles.push_back({first + face[0], first + face[1], first + face[2]});
}

/// A mesh of `count` triangles, each made alone.
template <class Make>
IndexedMesh each(std::uint32_t count, const Make& make) {
  IndexedMesh mesh;
  Numbers numbers;
  for (std::uint32_t i = 0; i < count; ++i) make(mesh, numbers);
  return mesh;
}

Vec3 on_rim(std::uint32_t i, std::uint32_t sides, double z) {
  const double angle = 6.283185307179586 * i / sides;
  return {std::cos(angle), std::sin(angle), z};
}

template <std::uint32_t kSides>
IndexedMesh cylinder(std::uint32_t triangles) {
  return fan_cylinder_mesh(kSides, triangles < 4 * kSides ? 1 : (triangles / kSides - 2) / 2);
}

IndexedMesh cone(std::uint32_t triangles, bool closed) {
  IndexedMesh mesh;
  const std::uint32_t sides = closed ? triangles / 2 : triangles;
  for (std::uint32_t i = 0; i < sides; ++i) add(mesh, on_rim(i, sides, 0));
  const std::uint32_t top = add(mesh, {0, 0, 1}), bottom = closed ? add(mesh, {0, 0, -1}) : 0;
  for (std::uint32_t i = 0; i < sides; ++i) {
    mesh.triangles.push_back({i, (i + 1) % sides, top});
    if (closed) mesh.triangles.push_back({(i + 1) % sides, i, bottom});
  }
  return mesh;
}

IndexedMesh spokes(std::uint32_t triangles) {
  IndexedMesh mesh = each(triangles, [](IndexedMesh& to, Numbers& numbers) {
    const Vec3 end = numbers.on_sphere();
    const std::uint32_t a = add(to, end), b = add(to, plus(end, numbers.in_cube(0.003)));
    to.triangles.push_back({a, b, 0});
  });
  const std::uint32_t centre = add(mesh, {0, 0, 0});
  for (Face& face : mesh.triangles) face[2] = centre;
  return mesh;
}

/// Each needle goes from one point of a sphere to another.
void needle(IndexedMesh& mesh, Numbers& numbers) {
  const Vec3 a = numbers.on_sphere(), b = numbers.on_sphere();
  add_triangle(mesh, a, b, plus(b, numbers.in_cube(0.002)));
}
void solid_needle(IndexedMesh& mesh, Numbers& numbers) {
  const Vec3 a = numbers.on_sphere(), b = numbers.on_sphere();
  const Vec3 c = plus(b, numbers.in_cube(0.002)), d = plus(b, numbers.in_cube(0.002));
  add_tetrahedron(mesh, {a, b, c, d});
}

/// A wavy ribbon of triangles that are each as long as the ribbon is wide.
IndexedMesh ruled_ribbon(std::uint32_t triangles) {
  IndexedMesh mesh;
  const std::uint32_t steps = triangles / 2;
  for (std::uint32_t i = 0; i <= steps; ++i) {
    const double x = 2.0 * i / steps - 1;
    add(mesh, {x, -1, 0.1 * std::sin(9 * x)});
    add(mesh, {x, 1, 0.1 * std::cos(7 * x)});
  }
  for (std::uint32_t i = 0; i < steps; ++i) {
    mesh.triangles.push_back({2 * i, 2 * i + 2, 2 * i + 1});
    mesh.triangles.push_back({2 * i + 1, 2 * i + 2, 2 * i + 3});
  }
  return mesh;
}

/// Bars of a tenth of a thousandth beside each other, each with six times two triangles.
IndexedMesh bars(std::uint32_t triangles) {
  IndexedMesh mesh;
  const std::uint32_t side = std::max(1u, static_cast<std::uint32_t>(std::sqrt(triangles / 12.0)));
  constexpr std::array<Face, 12> kFaces{{{0, 2, 1},
                                         {1, 2, 3},
                                         {4, 5, 6},
                                         {5, 7, 6},
                                         {0, 1, 4},
                                         {1, 5, 4},
                                         {2, 6, 3},
                                         {3, 6, 7},
                                         {0, 4, 2},
                                         {2, 4, 6},
                                         {1, 3, 5},
                                         {3, 7, 5}}};
  for (std::uint32_t i = 0; i < side * side; ++i) {
    const double x = static_cast<double>(i % side) / side, y = static_cast<double>(i / side) / side,
                 edge = 0.5 / side;
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (unsigned k = 0; k < 8; ++k)
      add(mesh, {x + edge * (k & 1), y + edge * (k >> 1 & 1), (k >> 2) * 1.0});
    for (const Face& face : kFaces)
      mesh.triangles.push_back({first + face[0], first + face[1], first + face[2]});
  }
  return mesh;
}

IndexedMesh repeated_tetrahedron(std::uint32_t triangles) {
  IndexedMesh mesh;
  const std::uint32_t copies = std::max(1u, triangles / 4);
  for (std::uint32_t i = 0; i < copies; ++i)
    add_tetrahedron(mesh, {Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0.25, 0.875, 0}, Vec3{0.5, 0.25, 1}});
  return mesh;
}

/// Tetrahedra of almost the same place, each in the next but for rounding.
IndexedMesh shells(std::uint32_t triangles) {
  IndexedMesh mesh;
  const std::uint32_t copies = std::max(1u, triangles / 4);
  for (std::uint32_t i = 0; i < copies; ++i) {
    const double s = 1 + 0.01 * i / copies;
    add_tetrahedron(mesh, {Vec3{-s, -s, -s}, Vec3{s, -0.9 * s, -s}, Vec3{-0.1 * s, s, -0.8 * s},
                           Vec3{0.1 * s, 0, s}});
  }
  return mesh;
}

}  // namespace

std::vector<std::array<Vec3, 3>> IndexedMesh::soup() const {
  std::vector<std::array<Vec3, 3>> soup;
  for (const Face& face : triangles)
    soup.push_back({vertices[face[0]], vertices[face[1]], vertices[face[2]]});
  return soup;
}

IndexedMesh fan_cylinder_mesh(std::uint32_t sides, std::uint32_t rings) {
  IndexedMesh mesh;
  for (std::uint32_t ring = 0; ring <= rings; ++ring)
    for (std::uint32_t i = 0; i < sides; ++i) add(mesh, on_rim(i, sides, 2.0 * ring / rings));
  const std::uint32_t bottom = add(mesh, {0, 0, 0}), top = add(mesh, {0, 0, 2});
  for (std::uint32_t i = 0; i < sides; ++i) {
    const std::uint32_t next = (i + 1) % sides, last = rings * sides;
    for (std::uint32_t row = 0; row < last; row += sides) {
      mesh.triangles.push_back({row + i, row + next, row + sides + next});
      mesh.triangles.push_back({row + i, row + sides + next, row + sides + i});
    }
    mesh.triangles.push_back({last + i, last + next, top});
    mesh.triangles.push_back({next, i, bottom});
  }
  return mesh;
}

std::span<const DegenerateKind> degenerate_kinds() {
  static constexpr DegenerateKind kKinds[] = {
      {"cylinder-1K", "closed cylinder of 1,000 sides, ends are fans", cylinder<1000>},
      {"cylinder-10K", "the same of 10,000 sides", cylinder<10000>},
      {"cylinder-100K", "the same of 100,000 sides", cylinder<100000>},
      {"cylinder-300K", "the same of 300,000 sides", cylinder<300000>},
      {"double-cone", "closed, two vertices of half of the triangles each",
       [](std::uint32_t n) { return cone(n, true); }},
      {"open-cone", "open, one vertex of all triangles",
       [](std::uint32_t n) { return cone(n, false); }},
      {"spokes", "thin triangles from one vertex to all sides", spokes},
      {"needles", "thin triangles across the model",
       [](std::uint32_t n) { return each(n, needle); }},
      {"solid-needles", "closed, thin tetrahedra across the model",
       [](std::uint32_t n) { return each(n / 4, solid_needle); }},
      {"ribbon", "a wavy ribbon of triangles as long as it is wide", ruled_ribbon},
      {"bars", "closed, thin bars beside each other", bars},
      {"coincident", "one triangle many times",
       [](std::uint32_t n) {
         return each(n, [](IndexedMesh& mesh, Numbers&) {
           add_triangle(mesh, {0, 0, 0}, {1, 0, 0.25}, {0.5, 1, 0.5});
         });
       }},
      {"coincident-solid", "closed, one tetrahedron many times", repeated_tetrahedron},
      {"shells", "closed, tetrahedra a tiny bit larger each than the one before", shells},
      {"overlapping", "large triangles of one plane",
       [](std::uint32_t n) {
         return each(n, [](IndexedMesh& mesh, Numbers& numbers) {
           std::array<Vec3, 3> p;
           for (Vec3& corner : p) {
             corner = numbers.in_cube();
             corner.z = 0;
           }
           add_triangle(mesh, p[0], p[1], p[2]);
         });
       }},
      {"large", "large triangles anywhere",
       [](std::uint32_t n) {
         return each(n, [](IndexedMesh& mesh, Numbers& numbers) {
           const Vec3 a = numbers.in_cube(), b = numbers.in_cube(), c = numbers.in_cube();
           add_triangle(mesh, a, b, c);
         });
       }},
      {"segments", "segments across the model, each a triangle with two equal corners",
       [](std::uint32_t n) {
         return each(n, [](IndexedMesh& mesh, Numbers& numbers) {
           const Vec3 a = numbers.in_cube(), b = numbers.in_cube();
           add_triangle(mesh, a, b, b);
         });
       }},
      {"short-segments", "the same, a thousandth long",
       [](std::uint32_t n) {
         return each(n, [](IndexedMesh& mesh, Numbers& numbers) {
           const Vec3 a = numbers.in_cube(), b = plus(a, numbers.in_cube(0.001));
           add_triangle(mesh, a, b, a);
         });
       }},
      {"one-segment", "one segment many times",
       [](std::uint32_t n) {
         return each(n, [](IndexedMesh& mesh, Numbers&) {
           add_triangle(mesh, {0, 0, 0}, {1, 0.5, 0.25}, {1, 0.5, 0.25});
         });
       }},
      {"points", "points, each a triangle with three equal corners",
       [](std::uint32_t n) {
         return each(n, [](IndexedMesh& mesh, Numbers& numbers) {
           const Vec3 a = numbers.in_cube();
           add_triangle(mesh, a, a, a);
         });
       }},
      {"one-point", "one point many times, and one triangle",
       [](std::uint32_t n) {
         IndexedMesh mesh = each(n - 1, [](IndexedMesh& to, Numbers&) {
           add_triangle(to, {0.3, 0.4, 0.5}, {0.3, 0.4, 0.5}, {0.3, 0.4, 0.5});
         });
         add_triangle(mesh, {0, 0, 0}, {1, 0, 0}, {0, 1, 1});
         return mesh;
       }},
  };
  return kKinds;
}

const DegenerateKind* degenerate_kind(std::string_view name) {
  const auto kinds = degenerate_kinds();
  const auto found = std::ranges::find(kinds, name, &DegenerateKind::name);
  return found == kinds.end() ? nullptr : &*found;
}

}  // namespace planetree::octree
