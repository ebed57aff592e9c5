#include "tests/golden/attributes/painted_mesh.h"

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <stdexcept>
#include <string>

#include "tests/golden/samples.h"

namespace planetree::golden {
namespace {

struct PaintedVertex {
  SpecPoint point;
  SpecColour colour;
  SpecUv uv;
};

struct PaintedFace {
  std::vector<std::size_t> corners;
  double value;
};

PaintedVertex painted_vertex(std::istream& ply) {
  PaintedVertex vertex{};
  for (double& coordinate : vertex.point) ply >> coordinate;
  for (std::uint8_t& channel : vertex.colour) {
    unsigned value = 0;
    ply >> value;
    channel = static_cast<std::uint8_t>(value);
  }
  for (float& coordinate : vertex.uv) ply >> coordinate;
  return vertex;
}

PaintedFace painted_face(std::istream& ply) {
  std::size_t count = 0;
  ply >> count;
  PaintedFace face{std::vector<std::size_t>(count), 0};
  for (std::size_t& corner : face.corners) ply >> corner;
  ply >> face.value;
  return face;
}

}  // namespace

// "Input and triangle indices": all polygons of the mesh are convex, so each is its fan.
std::vector<std::optional<PaintedTriangle>> painted_triangles() {
  std::ifstream ply(painted_sample().mesh_path());
  std::size_t vertex_count = 0, face_count = 0;
  for (std::string line; std::getline(ply, line) && line != "end_header";) {
    if (line.starts_with("element vertex ")) vertex_count = std::stoul(line.substr(15));
    if (line.starts_with("element face ")) face_count = std::stoul(line.substr(13));
  }
  std::vector<PaintedVertex> vertices;
  while (vertices.size() < vertex_count) vertices.push_back(painted_vertex(ply));

  std::vector<std::optional<PaintedTriangle>> triangles;
  for (std::size_t read = 0; read < face_count; ++read) {
    const PaintedFace face = painted_face(ply);
    const bool is_usable =
        std::ranges::all_of(face.corners, [&](std::size_t at) { return at < vertex_count; });
    for (std::size_t i = 1; i + 1 < face.corners.size(); ++i) {
      triangles.emplace_back();
      if (!is_usable) continue;
      const std::size_t fan[3] = {face.corners[0], face.corners[i], face.corners[i + 1]};
      PaintedTriangle& triangle = triangles.back().emplace();
      triangle.value = face.value;
      for (std::size_t k = 0; k < 3; ++k) {
        triangle.corners[k] = vertices[fan[k]].point;
        triangle.colours[k] = vertices[fan[k]].colour;
        triangle.uvs[k] = vertices[fan[k]].uv;
      }
    }
  }
  if (!ply) throw std::runtime_error("painted.ply ends too early");
  return triangles;
}

}  // namespace planetree::golden
