#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "octree/builder/mesh/ply_attributes.h"
#include "octree/builder/mesh/ply_body.h"
#include "octree/builder/mesh/ply_face_words.h"
#include "octree/builder/mesh/ply_strips.h"
#include "octree/builder/mesh/ply_words.h"
#include "octree/builder/mesh/stream/face_vertex_join.h"
#include "octree/builder/mesh/stream/fan_emitter.h"
#include "octree/builder/mesh/stream/indexed_face.h"
#include "octree/builder/mesh/stream/mesh_file.h"
#include "octree/builder/mesh/stream/mesh_scratch.h"
#include "octree/builder/mesh/stream/text_vertices.h"

namespace planetree::octree {

/// An ascii body: words, whatever the lines are. Vertices are spilled as they are read, as floats
/// where the header declares no wider type.
///
/// Of a body with loose lines, as OFF has, each record begins a line, as long as every vertex does.
/// Otherwise it is read as words too, if it cannot be understood in two ways.
class PlyAscii final : public PlyBody {
 public:
  /// All arguments must outlive this.
  PlyAscii(const MeshFile& file, const PlyHeader& header, const PlyAttributes& attributes,
           FanEmitter& emitter, MeshScratch& scratch);

  Result<TextPosition> skip(const PlyElement& element, TextPosition begin) override;
  Result<TextPosition> vertices(TextPosition begin) override;
  Result<TextPosition> faces(TextPosition begin) override;
  Result<void> expect_end(TextPosition end) override;
  [[nodiscard]] std::vector<std::string> notes() const override;

 private:
  /// Where reading strips goes on.
  struct StripPosition {
    PlyStrips strips;
    PlyWords::State words;
    std::uint64_t record = 0;  ///< number of the list
    std::int64_t left = 0;     ///< indices left in the list
  };

  /// Calls take(record, words), which returns Result<bool>, for each record from `from` on, until
  /// it returns false. Returns the position of that record, or the position behind the last record.
  template <class Take>
  Result<FacePosition> each_record(const PlyElement& element, const FacePosition& from,
                                   const Take& take);
  /// Calls take(triangle) for each triangle of strips, as FaceVertexJoin::deliver() requires.
  template <class Take>
  Result<FacePosition> each_triangle(const FacePosition& from, const Take& take);
  Result<TextPosition> read_vertices(TextPosition begin);
  Result<bool> take_vertex(PlyWords& words);
  /// Ends a vertex of a body with loose lines: compares what follows it with the first.
  Result<bool> end_loose_vertex(PlyWords& words);
  /// Reads a face into indices_ and face_words_.
  Result<void> take_face(PlyWords& words);
  /// Whether lines of a body with loose lines have several faces each.
  Result<bool> faces_share_lines(TextPosition begin);

  const MeshFile& file_;
  const PlyHeader& header_;
  const PlyAttributes& attributes_;
  FanEmitter& emitter_;
  MeshScratch& scratch_;
  /// Number that each property of a vertex is, or -1: a coordinate (0 to 2) or, from 3 on, one of
  /// PlyAttributes::vertex_numbers.
  std::vector<int> numbers_;
  std::optional<TextVertices> vertices_;
  PlyLayout layout_;
  std::optional<std::uint64_t> words_behind_vertex_;  ///< as counted for the first
  bool may_be_words_ = false;          ///< loose lines look as if vertices began elsewhere
  std::vector<std::int64_t> indices_;  ///< vertices of the face being read
  PlyFaceWords face_words_;            ///< its attributes
  std::optional<StripPosition> stop_;  ///< where each_triangle() was stopped
  MeshNote rounded_, left_out_;
};

}  // namespace planetree::octree
