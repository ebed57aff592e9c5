#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "octree/builder/mesh/ply_attributes.h"
#include "octree/builder/mesh/ply_body.h"
#include "octree/builder/mesh/ply_face_bytes.h"
#include "octree/builder/mesh/ply_records.h"
#include "octree/builder/mesh/ply_strips.h"
#include "octree/builder/mesh/ply_vertices.h"
#include "octree/builder/mesh/stream/face_vertex_join.h"
#include "octree/builder/mesh/stream/fan_emitter.h"
#include "octree/builder/mesh/stream/mesh_file.h"
#include "octree/builder/mesh/stream/mesh_scratch.h"
#include "octree/builder/mesh/stream/text_vertices.h"

namespace planetree::octree {

/// A binary PLY body. Vertices without lists are records of one size, so that their offsets are
/// computed; others are spilled as they are read. Bytes outside of the window of the file are read
/// when they are needed.
class PlyBinary final : public PlyBody {
 public:
  /// All arguments must outlive this.
  PlyBinary(const MeshFile& file, const PlyHeader& header, const PlyAttributes& attributes,
            FanEmitter& emitter, MeshScratch& scratch);

  Result<TextPosition> skip(const PlyElement& element, TextPosition begin) override;
  Result<TextPosition> vertices(TextPosition begin) override;
  Result<TextPosition> faces(TextPosition begin) override;
  Result<void> expect_end(TextPosition end) override;
  [[nodiscard]] std::vector<std::string> notes() const override;

 private:
  /// The items of one list in the file.
  struct ListSpan {
    std::uint64_t offset = 0;
    std::uint64_t count = 0;
  };
  /// Where reading strips goes on.
  struct StripPosition {
    PlyStrips strips;
    std::uint64_t record = 0;    ///< number of the list
    std::uint64_t position = 0;  ///< behind the list's record
    ListSpan list;               ///< what is left of the list
  };
  class Face;

  /// Reads vertices with lists.
  Result<TextPosition> spill_vertices(TextPosition begin);
  /// Adds a vertex with lists, whose properties are at these offsets.
  Result<void> spill_vertex(const std::vector<std::uint64_t>& offsets);
  /// Reads a number of a vertex; false if it cannot be read.
  bool read_number(const std::vector<std::uint64_t>& offsets, std::size_t property, double& number);
  /// Calls take(face) for each face, as FaceVertexJoin::deliver() requires.
  template <class Take>
  Result<FacePosition> each_face(const FacePosition& from, const Take& take);
  /// Calls take(triangle) for each triangle of strips, as FaceVertexJoin::deliver() requires.
  template <class Take>
  Result<FacePosition> each_triangle(const FacePosition& from, const Take& take);
  /// Steps over the record of a face, and sets `list` to the list of its vertices.
  Result<void> walk_face(std::uint64_t face, std::uint64_t& position, ListSpan& list) {
    return records_.walk(header_.faces(), face, position,
                         [&](std::size_t i, std::uint64_t offset, std::uint64_t count) {
                           if (i == header_.index_list) list = {offset, count};
                           face_bytes_.see(i, offset, count);
                         });
  }

  const MeshFile& file_;
  const PlyHeader& header_;
  const PlyAttributes& attributes_;
  FanEmitter& emitter_;
  MeshScratch& scratch_;
  PlyRecords records_;
  PlyVertices vertices_;
  PlyFaceBytes face_bytes_;
  std::optional<TextVertices> spilled_;  ///< in place of vertices_
  std::optional<StripPosition> stop_;    ///< where each_triangle() was stopped
  MeshNote left_out_;
};

}  // namespace planetree::octree
