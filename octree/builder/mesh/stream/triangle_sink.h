#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "planetree/error.h"
#include "planetree/types.h"

/// What a mesh reader hands on: triangles, and the records that give none.
namespace planetree::octree {

/// What a set-aside record is, and so how it is counted.
enum class RecordKind : std::uint8_t {
  kFace,   ///< face of a PLY or an OFF, from 0
  kFacet,  ///< facet of an STL, from 0
  kLine,   ///< first line of an OBJ's f statement, from 1
};

/// Why a record was set aside.
enum class RecordFault : std::uint8_t {
  kVertexNotFinite,  ///< a coordinate of a corner is NaN or infinite
  kIndexOutOfRange,  ///< a corner names a vertex that is not there
  kTooFewCorners,    ///< fewer than three corners
};

/// A record that gives no triangles. Only the first few need words, so the
/// sentence is made on demand.
struct SkippedRecord {
  RecordKind kind = RecordKind::kFace;
  RecordFault fault = RecordFault::kVertexNotFinite;
  std::uint64_t record = 0;
  /// The vertex or index as the file writes it (PLY and OFF from 0, OBJ from 1), an
  /// STL's corner from 0, or the number of corners, as `fault` has it.
  std::int64_t value = 0;
  std::uint64_t vertex_count = 0;  ///< vertices in the file, for kIndexOutOfRange

  /// One line, such as "face 17: vertex 5 is not finite".
  [[nodiscard]] std::string text() const;
};

/// Takes what a mesh reader finds, in the order of the input, on the thread
/// that called read_mesh. Indices arrive ascending and without a gap:
/// triangle() and skipped() together name each exactly once.
class TriangleSink {
 public:
  virtual ~TriangleSink() = default;

  /// A triangle with finite corners in model units, -0 given as +0. It may
  /// have no area. An error returned here ends the reading and is passed on.
  virtual Result<void> triangle(std::uint64_t index, const std::array<Vec3, 3>& corners) = 0;

  /// A record that takes the indices first_index ... first_index + count - 1
  /// and gives no triangle; count >= 1.
  virtual void skipped(std::uint64_t first_index, std::uint64_t count,
                       const SkippedRecord& why) = 0;

  /// Called about every 4 MiB and at the end; never decreases. bytes_total is the file's size,
  /// or twice that for a format that is read twice (OBJ). Where faces turn out to jump about,
  /// it grows by what is then to be done again.
  virtual void progress(std::uint64_t bytes_done, std::uint64_t bytes_total) = 0;
};

/// What a reading came to.
struct MeshSummary {
  std::uint64_t vertex_records = 0;    ///< vertices the file holds; three per STL facet
  std::uint64_t face_records = 0;      ///< faces, facets or f statements, set-aside ones included
  std::uint64_t triangle_indices = 0;  ///< indices given out, set-aside ones included
  bool float32 = false;  ///< the format declares coordinates that float32 holds exactly
};

}  // namespace planetree::octree
