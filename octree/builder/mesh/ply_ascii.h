#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "octree/builder/mesh/ply_body.h"
#include "octree/builder/mesh/stream/face_vertex_join.h"
#include "octree/builder/mesh/stream/fan_emitter.h"
#include "octree/builder/mesh/stream/mesh_file.h"
#include "octree/builder/mesh/stream/mesh_lines.h"
#include "octree/builder/mesh/stream/mesh_scratch.h"
#include "octree/builder/mesh/stream/text_vertices.h"

namespace planetree::octree {

/// An ascii body: one record a line; empty lines are ignored. Vertices are spilled as they are
/// read, as floats where the header declares no wider type.
class PlyAscii final : public PlyBody {
 public:
  /// All arguments must outlive this.
  PlyAscii(const MeshFile& file, const PlyHeader& header, FanEmitter& emitter,
           MeshScratch& scratch);

  Result<TextPosition> skip(const PlyElement& element, TextPosition begin) override;
  Result<TextPosition> vertices(TextPosition begin) override;
  Result<TextPosition> faces(TextPosition begin) override;
  Result<void> expect_end(TextPosition end) override;

 private:
  class Face;

  [[nodiscard]] MeshLines lines_from(TextPosition begin) const;
  /// Calls take_line(record, lines), which returns Result<bool>, for the line of each record from
  /// `from` on, until it returns false. Returns the position of that line, or the position behind
  /// the last record.
  template <class TakeLine>
  Result<FacePosition> each_line(const PlyElement& element, const FacePosition& from,
                                 const TakeLine& take_line);
  Result<void> take_vertex(const MeshLines& lines);
  /// Reads the line of a face into indices_.
  Result<void> take_face(const MeshLines& lines);

  const MeshFile& file_;
  const PlyHeader& header_;
  FanEmitter& emitter_;
  MeshScratch& scratch_;
  std::vector<int> axes_;  ///< axis (0 to 2) of each property of a vertex, or -1
  TextVertices vertices_;
  /// Words behind the values of each vertex, as counted for the first; only with loose lines.
  std::optional<std::uint64_t> words_behind_vertex_;
  std::vector<std::int64_t> indices_;  ///< vertices of the face being read
};

}  // namespace planetree::octree
