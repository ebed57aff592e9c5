// Makes a mesh finer and rough, like a scan: each triangle becomes pieces * pieces triangles, and
// every vertex moves at random by a share of the new edges' length. The output depends on the mesh,
// the pieces and the seed alone.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <bit>
#include <cmath>
#include <fstream>
#include <iostream>
#include <string>
#include <vector>

#include "bench/peer.h"

static_assert(std::endian::native == std::endian::little, "written as it is in memory");

namespace planetree::bench {
namespace {

struct Arguments {
  std::string mesh;
  std::string output;
  std::uint32_t pieces = 10;
  std::uint64_t seed = 1;
};

// Maximum move of a vertex on each axis, as a share of the mean new edge.
constexpr double kRoughness = 0.2;

// The finer mesh. Its vertices are numbered in this order: the mesh's vertices, those on its edges,
// those inside its triangles.
class FinerMesh {
 public:
  FinerMesh(const PeerMesh& mesh, std::uint32_t pieces, std::uint64_t seed)
      : mesh_(mesh), pieces_(pieces), seed_(seed) {
    edges_.reserve(mesh.corners.size());
    double length = 0;
    for (std::size_t i = 0; i < mesh.corners.size(); ++i) {
      const std::uint32_t a = mesh.corners[i], b = mesh.corners[i - i % 3 + (i + 1) % 3];
      edges_.push_back(key(a, b));
      length += std::sqrt(squared(a, b));
    }
    reach_ = kRoughness * length / static_cast<double>(edges_.size()) / pieces;
    std::sort(edges_.begin(), edges_.end());
    edges_.erase(std::unique(edges_.begin(), edges_.end()), edges_.end());
    first_inner_ = mesh.positions.size() / 3 + edges_.size() * (pieces_ - 1);
  }

  [[nodiscard]] std::uint64_t vertices() const {
    return first_inner_ + mesh_.triangles() * inner_per_triangle();
  }
  [[nodiscard]] std::uint64_t triangles() const { return mesh_.triangles() * pieces_ * pieces_; }

  void write_vertices(std::ostream& out) const {
    for (std::size_t i = 0; i < mesh_.positions.size() / 3; ++i) put(out, i, at(i, i, 0));
    std::uint64_t number = mesh_.positions.size() / 3;
    for (const std::uint64_t edge : edges_)
      for (std::uint32_t step = 1; step < pieces_; ++step)
        put(out, number++, at(edge >> 32, edge & 0xffffffff, step));
    for (std::size_t triangle = 0; triangle < mesh_.triangles(); ++triangle)
      for (std::uint32_t v = 1; v < pieces_; ++v)
        for (std::uint32_t u = 1; u + v < pieces_; ++u) put(out, number++, within(triangle, u, v));
  }

  void write_triangles(std::ostream& out) const {
    for (std::size_t triangle = 0; triangle < mesh_.triangles(); ++triangle)
      for (std::uint32_t v = 0; v < pieces_; ++v)
        for (std::uint32_t u = 0; u + v < pieces_; ++u) {
          put_face(out, number(triangle, u, v), number(triangle, u + 1, v),
                   number(triangle, u, v + 1));
          if (u + v + 2 <= pieces_)
            put_face(out, number(triangle, u + 1, v), number(triangle, u + 1, v + 1),
                     number(triangle, u, v + 1));
        }
  }

 private:
  using Position = std::array<double, 3>;

  static std::uint64_t key(std::uint32_t a, std::uint32_t b) {
    return std::uint64_t{std::min(a, b)} << 32 | std::max(a, b);
  }
  double squared(std::uint32_t a, std::uint32_t b) const {
    double sum = 0;
    for (unsigned axis = 0; axis < 3; ++axis) {
      const double side = double{mesh_.positions[3 * std::size_t{a} + axis]} -
                          double{mesh_.positions[3 * std::size_t{b} + axis]};
      sum += side * side;
    }
    return sum;
  }
  std::uint64_t inner_per_triangle() const {
    return std::uint64_t{pieces_ - 1} * (pieces_ - 2) / 2;
  }

  // The position `step` pieces from vertex a towards vertex b.
  Position at(std::size_t a, std::size_t b, std::uint32_t step) const {
    Position position{};
    const double share = static_cast<double>(step) / pieces_;
    for (unsigned axis = 0; axis < 3; ++axis)
      position[axis] =
          mesh_.positions[3 * a + axis] * (1 - share) + mesh_.positions[3 * b + axis] * share;
    return position;
  }
  Position within(std::size_t triangle, std::uint32_t u, std::uint32_t v) const {
    Position position{};
    const double shares[3] = {static_cast<double>(pieces_ - u - v) / pieces_,
                              static_cast<double>(u) / pieces_, static_cast<double>(v) / pieces_};
    for (unsigned corner = 0; corner < 3; ++corner)
      for (unsigned axis = 0; axis < 3; ++axis)
        position[axis] +=
            shares[corner] *
            mesh_.positions[3 * std::size_t{mesh_.corners[3 * triangle + corner]} + axis];
    return position;
  }

  // The number of the vertex that is u pieces from the first corner towards the second and v pieces
  // towards the third.
  std::uint32_t number(std::size_t triangle, std::uint32_t u, std::uint32_t v) const {
    const std::uint32_t* const corner = &mesh_.corners[3 * triangle];
    if (v == 0) return on_edge(corner[0], corner[1], u);
    if (u == 0) return on_edge(corner[0], corner[2], v);
    if (u + v == pieces_) return on_edge(corner[1], corner[2], v);
    const std::uint64_t rows_before =
        std::uint64_t{v - 1} * (pieces_ - 1) - std::uint64_t{v} * (v - 1) / 2;
    return static_cast<std::uint32_t>(first_inner_ + triangle * inner_per_triangle() + rows_before +
                                      u - 1);
  }
  std::uint32_t on_edge(std::uint32_t a, std::uint32_t b, std::uint32_t step) const {
    if (step == 0) return a;
    if (step == pieces_) return b;
    const auto edge = std::lower_bound(edges_.begin(), edges_.end(), key(a, b)) - edges_.begin();
    const std::uint32_t from_lower = a < b ? step : pieces_ - step;
    return static_cast<std::uint32_t>(mesh_.positions.size() / 3 +
                                      static_cast<std::size_t>(edge) * (pieces_ - 1) + from_lower -
                                      1);
  }

  // A random number in [-1, 1): SplitMix64 (Steele, Lea and Flood).
  double noise(std::uint64_t at) const {
    std::uint64_t z = (at + seed_ * 0x100000001) * 0x9e3779b97f4a7c15;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9;
    z = (z ^ z >> 27) * 0x94d049bb133111eb;
    return static_cast<double>((z ^ z >> 31) >> 11) * 0x1p-52 - 1;
  }
  void put(std::ostream& out, std::uint64_t number, const Position& position) const {
    std::array<float, 3> noisy{};
    for (unsigned axis = 0; axis < 3; ++axis)
      noisy[axis] = static_cast<float>(position[axis] + reach_ * noise(3 * number + axis));
    out.write(reinterpret_cast<const char*>(noisy.data()), sizeof noisy);
  }
  static void put_face(std::ostream& out, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    const std::array<std::uint32_t, 3> face{a, b, c};
    out.put(3).write(reinterpret_cast<const char*>(face.data()), sizeof face);
  }

  const PeerMesh& mesh_;
  const std::uint32_t pieces_;
  const std::uint64_t seed_;
  std::vector<std::uint64_t> edges_;
  double reach_ = 0;
  std::uint64_t first_inner_ = 0;
};

int run(const Arguments& arguments) {
  const auto mesh = read_peer_mesh(arguments.mesh.c_str());
  if (!mesh) {
    std::cerr << arguments.mesh << ": " << mesh.error().text << "\n";
    return 1;
  }
  const FinerMesh finer(*mesh, arguments.pieces, arguments.seed);
  if (finer.vertices() >= std::uint64_t{1} << 32) {
    std::cerr << arguments.mesh << ": too many vertices; give fewer pieces\n";
    return 2;
  }
  std::ofstream out(arguments.output, std::ios::binary);
  out << fmt::format(
      "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\n"
      "property float y\nproperty float z\nelement face {}\n"
      "property list uchar uint vertex_indices\nend_header\n",
      finer.vertices(), finer.triangles());
  finer.write_vertices(out);
  finer.write_triangles(out);
  if (!out.flush()) {
    std::cerr << arguments.output << ": cannot be written\n";
    return 3;
  }
  fmt::print("{}: {} triangles\n", arguments.output, finer.triangles());
  return 0;
}

}  // namespace
}  // namespace planetree::bench

int main(int argc, char** argv) {
  planetree::bench::Arguments arguments;
  CLI::App app("Makes a mesh finer and rough, like a scan");
  app.add_option("mesh", arguments.mesh, "Mesh to begin with")->required();
  app.add_option("output", arguments.output, "PLY file to write")->required();
  app.add_option("--pieces", arguments.pieces,
                 "Pieces of each edge; each triangle becomes pieces * pieces triangles")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  app.add_option("--seed", arguments.seed, "Chooses the noise")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  return planetree::bench::run(arguments);
}
