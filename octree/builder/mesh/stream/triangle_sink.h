#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "planetree/attributes.h"
#include "planetree/error.h"
#include "planetree/types.h"

/// What a mesh reader delivers: triangles, and the records that give none.
namespace planetree::octree {

/// Kind of a skipped record, and how such records are counted.
enum class RecordKind : std::uint8_t {
  kFace,      ///< face of a PLY, an OFF or a mesh in memory, from 0
  kFacet,     ///< facet of an STL, from 0
  kLine,      ///< first line of an OBJ's f statement, from 1
  kTriangle,  ///< triangle of a callback, from 0
};

/// Why a record was skipped.
enum class RecordFault : std::uint8_t {
  kVertexNotFinite,  ///< a coordinate of a corner is NaN or infinite
  kIndexOutOfRange,  ///< a corner names a vertex that does not exist
  kTooFewCorners,    ///< fewer than three corners
};

/// A record that gives no triangles. The sentence about it is made on demand, since only the first
/// few records need one.
struct SkippedRecord {
  RecordKind kind = RecordKind::kFace;
  RecordFault fault = RecordFault::kVertexNotFinite;
  std::uint64_t record = 0;
  /// By `fault`: the vertex or index as the input writes it (PLY, OFF and memory from 0, OBJ from
  /// 1), the corner of an STL or a callback from 0, or the number of corners.
  std::int64_t value = 0;
  std::uint64_t vertex_count = 0;  ///< vertices of the mesh, for kIndexOutOfRange
  /// Path of the file of the record, where the input is several files; else null.
  const std::string* file = nullptr;

  /// One line, such as "face 17: vertex 5 is not finite"; before it the path of the file, if set.
  [[nodiscard]] std::string text() const;
};

/// Names a record, such as "face 17".
std::string record_name(RecordKind kind, std::uint64_t record);

/// What a mesh has for a triangle beside its corners. What is not read is as it is here.
struct TriangleAttributes {
  std::array<Color, 3> colors = {};           ///< of the corners
  std::array<TextureCoordinate, 3> uvs = {};  ///< of the corners
  std::uint64_t value = 0;                    ///< the bits, see MeshSummary::value_kind
};

/// Receives what a mesh reader finds, in the order of the input, on the thread that called
/// read_mesh(). Indices ascend without a gap: triangle() and skipped() together name each index
/// exactly once.
class TriangleSink {
 public:
  virtual ~TriangleSink() = default;

  /// Receives a triangle. Its corners are finite and in model units, with +0 in place of -0. It may
  /// have no area. An error ends the reading and is returned from it.
  virtual Result<void> triangle(std::uint64_t index, const std::array<Vec3, 3>& corners) = 0;

  /// Receives the attributes of the triangle that was delivered last, if MeshOptions::keep names
  /// any. An error ends the reading and is returned from it.
  virtual Result<void> attributes(const TriangleAttributes& attributes);

  /// Receives a record that takes the indices first_index ... first_index + count - 1 and gives no
  /// triangle; count >= 1.
  virtual void skipped(std::uint64_t first_index, std::uint64_t count,
                       const SkippedRecord& why) = 0;

  /// Reports progress about every 4 MiB and at the end; bytes_done never decreases. bytes_total is
  /// the file's size, or twice that for a format that is read twice (OBJ), or the size of all
  /// indices (glTF). Where corners have to be
  /// sorted, it grows by the work that this adds. An error ends the reading and is returned from
  /// it.
  virtual Result<void> progress(std::uint64_t bytes_done, std::uint64_t bytes_total) = 0;
};

/// Polygons that were split though they are odd; see PolygonFault. The first of each kind is named
/// in words, such as "face 17: a polygon of 8 corners crosses itself".
struct OddPolygons {
  std::uint64_t nonplanar = 0;  ///< not convex, and not in one plane
  std::uint64_t fanned = 0;     ///< split into fans that may reach beyond them
  std::string first_nonplanar, first_fanned;
};

/// Result of a reading.
struct MeshSummary {
  std::uint64_t vertex_records =
      0;  ///< vertices listed; three per facet of an STL or triangle of a callback
  std::uint64_t face_records = 0;  ///< faces, facets, f statements or triangles, with skipped ones
  std::uint64_t triangle_indices = 0;  ///< indices given out, those of skipped records included
  bool float32 = false;  ///< float32 holds every value of the declared coordinate types
  OddPolygons odd_polygons = {};
  ValueKind value_kind = ValueKind::kUnsigned;  ///< type of TriangleAttributes::value
  /// What the reader passed over or took in another way than it is written, a line for each kind.
  std::vector<std::string> notes = {};
  /// Of files, the indices that each has given out, in order.
  std::vector<std::uint64_t> file_indices = {};
};

}  // namespace planetree::octree
