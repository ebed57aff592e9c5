// A program of somebody else: builds a model in memory, opens it and asks it.
// usage: program OUT.ptree

#include <planetree/planetree.h>

#include <cstdio>
#include <vector>

int main(int, char** argv) {
  const std::vector<planetree::Vec3> vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const std::vector<planetree::TriangleVertices> triangles = {
      {0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  planetree::BuildOptions options;
  options.replace = true;
  const auto report = planetree::build({vertices, triangles}, argv[1], options);
  if (!report) return std::fprintf(stderr, "%s\n", report.error().text), 1;
  const auto model = planetree::Model::open(argv[1]);
  if (!model) return std::fprintf(stderr, "%s\n", model.error().text), 1;
  auto probe = planetree::Probe::create(*model);
  if (!probe) return std::fprintf(stderr, "%s\n", probe.error().text), 1;
  const planetree::ClosestPoint nearest = probe->closest_point({0.25, 0.25, -2});
  std::printf("%g\n", nearest.signed_distance());
  return nearest.status == planetree::Status::kExact && nearest.distance == 2 ? 0 : 1;
}
