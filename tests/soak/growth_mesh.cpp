// Writes a mesh of one of the kinds that make careless builds slow: a binary PLY file of floats.

#include <charconv>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <string_view>

#include "tests/octree/support/degenerate_meshes.h"

namespace planetree::octree {
namespace {

template <class T>
void put(std::ofstream& file, T value) {
  file.write(reinterpret_cast<const char*>(&value), sizeof value);
}

void write_ply(std::ofstream& file, const IndexedMesh& mesh) {
  file << "ply\nformat binary_little_endian 1.0\nelement vertex " << mesh.vertices.size()
       << "\nproperty float x\nproperty float y\nproperty float z\nelement face "
       << mesh.triangles.size() << "\nproperty list uchar uint vertex_indices\nend_header\n";
  for (const Vec3& p : mesh.vertices)
    for (const double value : {p.x, p.y, p.z}) put(file, static_cast<float>(value));
  for (const auto& corners : mesh.triangles) {
    put<std::uint8_t>(file, 3);
    for (const std::uint32_t corner : corners) put(file, corner);
  }
}

int usage() {
  std::fprintf(stderr, "usage: growth_mesh --list | growth_mesh KIND TRIANGLES OUT.ply\n");
  for (const DegenerateKind& kind : degenerate_kinds())
    std::fprintf(stderr, "  %-18s%s\n", kind.name.data(), kind.about.data());
  return 2;
}

int run(int argc, char** argv) {
  if (argc == 2 && std::string_view(argv[1]) == "--list") {
    for (const DegenerateKind& kind : degenerate_kinds()) std::printf("%s\n", kind.name.data());
    return 0;
  }
  std::uint32_t triangles = 0;
  const DegenerateKind* const kind = argc == 4 ? degenerate_kind(argv[1]) : nullptr;
  if (!kind) return usage();
  const char* const end = argv[2] + std::strlen(argv[2]);
  const auto [rest, error] = std::from_chars(argv[2], end, triangles);
  if (error != std::errc() || rest != end || triangles < 4) return usage();
  const IndexedMesh mesh = kind->make(triangles);
  std::ofstream file(argv[3], std::ios::binary);
  write_ply(file, mesh);
  if (!file.flush()) {
    std::fprintf(stderr, "growth_mesh: %s cannot be written\n", argv[3]);
    return 1;
  }
  std::printf("%zu\n", mesh.triangles.size());
  return 0;
}

}  // namespace
}  // namespace planetree::octree

int main(int argc, char** argv) { return planetree::octree::run(argc, argv); }
