#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <string>
#include <unordered_map>
#include <vector>

#include "planetree/error.h"
#include "planetree/types.h"

namespace planetree::tools {

/// Hash and equality of positions, by their bits. -0 and 0 differ.
struct SamePosition {
  std::size_t operator()(const Vec3& point) const;
  bool operator()(const Vec3& a, const Vec3& b) const;
};
/// A number for each position.
using PositionNumbers = std::unordered_map<Vec3, std::uint32_t, SamePosition, SamePosition>;

/// Some triangles of a mesh, by the numbers of their corners. A position is a corner once.
struct MeshPiece {
  std::vector<Vec3> corners;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// Cuts a stream of triangles into pieces, and long triangles into shorter ones.
class MeshPieceMaker {
 public:
  static constexpr std::size_t kTriangles = 32768;  ///< most triangles of a piece
  static constexpr int kMaxCuts = 16;               ///< most times that a triangle is halved

  /// How long the edges of parts may be.
  struct Cuts {
    double spacing = std::numeric_limits<double>::infinity();  ///< model units
    int most = kMaxCuts;  ///< a triangle is not halved more often; at most kMaxCuts
  };
  /// Cuts by a spacing that nobody asked for: together they make at most about 4 million parts of a
  /// mesh of so many triangles, 0 if that is not known.
  static Cuts modest_cuts(double spacing, std::uint64_t triangles);

  /// Takes a piece. Its error ends the work.
  using Take = std::function<Result<void>(const MeshPiece&)>;

  /// Triangles are halved across their longest edge.
  MeshPieceMaker(const Cuts& cuts, Take take);

  /// errors  those of Take
  Result<void> add(const std::array<Vec3, 3>& corners);
  /// Hands over what is left. errors: those of Take
  Result<void> finish();

 private:
  Result<void> add_whole(const std::array<Vec3, 3>& corners);

  const Cuts cuts_;
  const Take take_;
  MeshPiece piece_;
  PositionNumbers numbers_;
};

/// What a mesh file was found to have.
struct MeshFindings {
  std::uint64_t triangles = 0;
  std::uint64_t skipped = 0;       ///< triangles of records that cannot be used
  std::string first_skipped;       ///< what is wrong with the first of these records
  std::vector<std::string> notes;  ///< as BuildReport::notes
};

/// Reads a mesh file of any format that `planetree build` reads, and gives its triangles to
/// `maker`.
///
/// memory_bytes  for reading; the rest goes to the system's directory for temporary files
/// progress      called now and then with the number of triangles read since the last call
/// errors        those of octree::read_mesh() and of MeshPieceMaker
Result<MeshFindings> read_mesh_pieces(const std::filesystem::path& path, std::uint64_t memory_bytes,
                                      MeshPieceMaker& maker,
                                      const std::function<void(std::uint64_t)>& progress);

/// An estimate of the number of triangles in a mesh file; 0 if there is none.
std::uint64_t estimated_triangles(const std::filesystem::path& path);

/// The middle of an edge, the same from both of its ends.
inline Vec3 middle_of(const Vec3& a, const Vec3& b) {
  return {a.x / 2 + b.x / 2, a.y / 2 + b.y / 2, a.z / 2 + b.z / 2};
}

/// The length of a vector, by arithmetic and square roots alone, which are the same everywhere.
double length_of(const Vec3& vector);
/// The distance of two points.
double distance_of(const Vec3& a, const Vec3& b);
/// The area of a triangle, for squares of edge `unit`. It is cut off where a sum of areas could
/// overflow.
double area_of(const std::array<Vec3, 3>& corners, double unit);

}  // namespace planetree::tools
