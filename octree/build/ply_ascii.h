#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "octree/build/mesh_delivery.h"
#include "octree/build/mesh_file.h"
#include "octree/build/ply_body.h"

namespace planetree::octree {

/// An ascii body: one record a line, empty lines aside. The vertices are kept
/// in memory, as floats where the header declares nothing wider.
class PlyAscii final : public PlyBody {
 public:
  /// All three must outlive this.
  PlyAscii(MeshFile& file, const PlyHeader& header, MeshDelivery& delivery);

  Result<TextPlace> skip(const PlyElement& element, TextPlace begin) override;
  Result<TextPlace> vertices(TextPlace begin) override;
  Result<TextPlace> faces(TextPlace begin) override;
  Result<void> expect_end(TextPlace end) override;

 private:
  [[nodiscard]] LineScanner lines_from(TextPlace begin) const noexcept;
  /// Calls take_line(record, lines) on the line of each record.
  template <class TakeLine>
  Result<TextPlace> each_line(const PlyElement& element, TextPlace begin,
                              const TakeLine& take_line);
  Result<void> take_vertex(const LineScanner& lines);
  /// Reads a face's line into indices_.
  Result<void> take_face(const LineScanner& lines);
  [[nodiscard]] MeshCorner corner(std::int64_t index) const noexcept;

  MeshFile& file_;
  const PlyHeader& header_;
  MeshDelivery& delivery_;
  std::vector<int> axes_;           ///< per property of a vertex: 0, 1, 2 for x, y, z, or -1
  bool float32_;                    ///< which of the two vectors below is used
  std::vector<float> floats_;       ///< x, y, z of each vertex read
  std::vector<double> doubles_;     ///< x, y, z of each vertex read
  std::uint64_t vertex_count_ = 0;  ///< vertices read
  std::optional<std::uint64_t> words_behind_vertex_;  ///< of loose lines: as of the first vertex
  std::vector<std::int64_t> indices_;                 ///< of the face being read
};

}  // namespace planetree::octree
