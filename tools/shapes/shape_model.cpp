#include "tools/shapes/shape_model.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "tools/shapes/shape_closed.h"
#include "tools/shapes/shape_open.h"

namespace planetree::tools {
namespace {

constexpr std::array<std::string_view, kAllShapeKinds.size()> kNames = {
    "statue", "sphere", "cylinder", "cone", "terrain", "soup"};

/// Far above what kMaxVertices allows for any shape, and far below an overflow.
constexpr std::uint64_t kMaxTriangles = std::uint64_t{1} << 40;

/// The n, at least 1, for which triangles_per_square * n^2 is nearest to `triangles`.
std::uint64_t lattice_size(std::uint64_t triangles, unsigned triangles_per_square) {
  const double squares = static_cast<double>(triangles) / triangles_per_square;
  return std::max<std::uint64_t>(1, static_cast<std::uint64_t>(std::sqrt(squares) + 0.5));
}

std::unique_ptr<Shape> make_unchecked(ShapeKind kind, std::uint64_t triangles, std::uint64_t seed) {
  switch (kind) {
    case ShapeKind::kStatue:
      return std::make_unique<Statue>(lattice_size(triangles, 12), seed);
    case ShapeKind::kSphere:
      return std::make_unique<Sphere>(lattice_size(triangles, 12));
    case ShapeKind::kCylinder:
      return std::make_unique<Cylinder>(lattice_size(triangles, 12));
    case ShapeKind::kCone:
      // The apex is the middle point, which only an even lattice has.
      return std::make_unique<Cone>(2 * lattice_size(triangles, 16));
    case ShapeKind::kTerrain:
      return std::make_unique<Terrain>(lattice_size(triangles, 2), seed);
    case ShapeKind::kSoup:
      return std::make_unique<Soup>(triangles, seed);
  }
  return nullptr;
}

}  // namespace

std::string_view shape_name(ShapeKind kind) { return kNames[static_cast<std::size_t>(kind)]; }

std::optional<ShapeKind> shape_named(std::string_view name) {
  const auto found = std::find(kNames.begin(), kNames.end(), name);
  if (found == kNames.end()) return std::nullopt;
  return static_cast<ShapeKind>(found - kNames.begin());
}

Result<std::unique_ptr<Shape>> make_shape(ShapeKind kind, std::uint64_t triangles,
                                          std::uint64_t seed) {
  if (triangles == 0) {
    return make_error(ErrorCode::kBadArgument, Error::kNowhere, Error::kNowhere,
                      "a model needs triangles; give at least 1");
  }
  auto shape = make_unchecked(kind, std::min(triangles, kMaxTriangles), seed);
  if (shape->vertex_count() > Shape::kMaxVertices) {
    return make_error(
        ErrorCode::kBadArgument, Error::kNowhere, Error::kNowhere,
        "%llu triangles need more vertices than a PLY index can address (2^32); give fewer",
        static_cast<unsigned long long>(triangles));
  }
  return shape;
}

}  // namespace planetree::tools
