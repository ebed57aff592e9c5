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

/// A binary PLY body. Vertices are records of one size, found by multiplying; what is not in a
/// window of the file is read when it is needed.
class PlyBinary final : public PlyBody {
 public:
  /// All must outlive this.
  PlyBinary(const MeshFile& file, const PlyHeader& header, FanEmitter& emitter,
            MeshScratch& scratch);

  Result<TextPosition> skip(const PlyElement& element, TextPosition begin) override;
  Result<TextPosition> vertices(TextPosition begin) override;
  Result<TextPosition> faces(TextPosition begin) override;
  Result<void> expect_end(TextPosition end) override;

 private:
  /// Items of one list in the file.
  struct ListSpan {
    std::uint64_t offset = 0;
    std::uint64_t count = 0;
  };
  class Face;

  /// Steps over the record at `position`, which is one of `element`. `list` is set for the list
  /// at property `list_property`.
  /// errors  kBadInput: it reaches past the file's end or has a list of negative length.
  Result<void> walk_record(const PlyElement& element, std::uint64_t record,
                           std::size_t list_property, std::uint64_t& position, ListSpan& list);
  /// The same; false where it is bad, or with unread_ set where it cannot be read.
  bool walk_properties(const PlyElement& element, std::size_t list_property,
                       std::uint64_t& position, ListSpan& list);
  /// As FaceVertexJoin::deliver() wants it.
  template <class Take>
  Result<FacePosition> each_face(const FacePosition& from, const Take& take);
  /// Refuses a count of records that cannot fit behind `begin`.
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
  bool unread_ = false;  ///< a record could not be read, rather than is bad
};

}  // namespace planetree::octree
