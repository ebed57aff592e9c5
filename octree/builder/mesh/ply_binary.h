#pragma once

#include <cstddef>
#include <cstdint>

#include "octree/builder/mesh/ply_body.h"
#include "octree/builder/mesh/ply_vertices.h"
#include "octree/builder/mesh/stream/face_vertex_join.h"
#include "octree/builder/mesh/stream/fan_emitter.h"
#include "octree/builder/mesh/stream/mesh_file.h"
#include "octree/builder/mesh/stream/mesh_scratch.h"
#include "octree/builder/mesh/stream/mesh_window.h"

namespace planetree::octree {

/// A binary PLY body. Vertices are records of one size, so that their offsets are computed. Bytes
/// outside of the window of the file are read when they are needed.
class PlyBinary final : public PlyBody {
 public:
  /// All arguments must outlive this.
  PlyBinary(const MeshFile& file, const PlyHeader& header, FanEmitter& emitter,
            MeshScratch& scratch);

  Result<TextPosition> skip(const PlyElement& element, TextPosition begin) override;
  Result<TextPosition> vertices(TextPosition begin) override;
  Result<TextPosition> faces(TextPosition begin) override;
  Result<void> expect_end(TextPosition end) override;

 private:
  /// The items of one list in the file.
  struct ListSpan {
    std::uint64_t offset = 0;
    std::uint64_t count = 0;
  };
  class Face;

  /// Steps over the record of `element` at `position`, and sets `list` to its list at property
  /// `list_property`.
  /// errors  kBadInput: the record reaches past the end of the file or has a list of negative
  ///         length.
  Result<void> walk_record(const PlyElement& element, std::uint64_t record,
                           std::size_t list_property, std::uint64_t& position, ListSpan& list);
  /// As walk_record(). False if the record is bad, or cannot be read.
  bool walk_properties(const PlyElement& element, std::size_t list_property,
                       std::uint64_t& position, ListSpan& list);
  /// Calls take(face) for each face, as FaceVertexJoin::deliver() requires.
  template <class Take>
  Result<FacePosition> each_face(const FacePosition& from, const Take& take);
  /// Refuses a count of records that do not fit in the file behind `begin`.
  [[nodiscard]] Result<void> check_space(const PlyElement& element, std::uint64_t begin) const;
  [[nodiscard]] Error bad_record(const PlyElement& element, std::uint64_t record,
                                 std::uint64_t offset) const;

  const MeshFile& file_;
  const PlyHeader& header_;
  FanEmitter& emitter_;
  MeshScratch& scratch_;
  const bool swap_;
  PlyVertices vertices_;
  MeshWindow window_;
  bool read_failed_ = false;  ///< the last record could not be read, so that it may not be bad
};

}  // namespace planetree::octree
