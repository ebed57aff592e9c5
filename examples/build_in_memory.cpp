// Makes a surface in memory, builds the file of it, and queries it.
// usage: build_in_memory OUT.ptree

#include <planetree/planetree.h>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <numbers>
#include <vector>

namespace {

struct Mesh {
  std::vector<planetree::Vec3> vertices;
  std::vector<planetree::TriangleVertices> triangles;
};

// A torus about the z axis: radius 2, and 0.75 of the tube. Its triangles face outwards.
Mesh make_torus(std::uint32_t round, std::uint32_t along) {
  Mesh mesh;
  for (std::uint32_t i = 0; i < round; ++i)
    for (std::uint32_t k = 0; k < along; ++k) {
      const double a = 2 * std::numbers::pi * i / round, b = 2 * std::numbers::pi * k / along;
      const double radius = 2 + 0.75 * std::cos(b);
      mesh.vertices.push_back({radius * std::cos(a), radius * std::sin(a), 0.75 * std::sin(b)});
    }
  for (std::uint32_t i = 0; i < round; ++i)
    for (std::uint32_t k = 0; k < along; ++k) {
      const std::uint32_t next_i = (i + 1) % round, next_k = (k + 1) % along;
      const std::uint32_t here = i * along + k, across = next_i * along + next_k;
      mesh.triangles.push_back({here, next_i * along + k, across});
      mesh.triangles.push_back({here, across, i * along + next_k});
    }
  return mesh;
}

int fail(const char* path, const planetree::Error& error) {
  std::fprintf(stderr, "build_in_memory: %s: %s\n", path, error.text);
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: build_in_memory OUT.ptree\n");
    return 2;
  }
  const Mesh mesh = make_torus(400, 200);
  planetree::BuildOptions options;
  options.memory_bytes = std::uint64_t{512} << 20;
  options.replace = true;
  // Reports each phase once. Returning false would cancel the build and leave nothing.
  options.on_progress = [](planetree::BuildPhase phase, std::uint64_t done, std::uint64_t total) {
    if (done == total) std::printf("%s: done\n", planetree::name_of(phase));
    return true;
  };
  const auto report = planetree::build({mesh.vertices, mesh.triangles}, argv[1], options);
  if (!report) return fail(argv[1], report.error());
  std::printf("%llu triangles, %s, %llu bytes\n",
              static_cast<unsigned long long>(report->triangles),
              report->watertight() ? "watertight" : "open",
              static_cast<unsigned long long>(report->file_bytes));

  const auto model = planetree::Model::open(argv[1]);
  if (!model) return fail(argv[1], model.error());
  auto probe = planetree::Probe::create(*model);
  if (!probe) return fail(argv[1], probe.error());
  for (const planetree::Vec3& point : {planetree::Vec3{0, 0, 0}, planetree::Vec3{2, 0, 0}}) {
    const planetree::ClosestPoint nearest = probe->closest_point(point);
    std::printf("(%g, %g, %g) is %s, %.4f from the surface\n", point.x, point.y, point.z,
                nearest.side == planetree::Side::kInside ? "inside" : "outside", nearest.distance);
  }
}
