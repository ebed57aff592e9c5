#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "octree/build/mesh_delivery.h"
#include "octree/build/mesh_file.h"
#include "octree/build/ply_body.h"

namespace planetree::octree {

/// A binary PLY body. Vertices are records of one size, found by multiplying;
/// none is copied, so their number costs no memory.
class PlyBinary final : public PlyBody {
 public:
  /// All three must outlive this.
  PlyBinary(MeshFile& file, const PlyHeader& header, MeshDelivery& delivery);

  Result<TextPlace> skip(const PlyElement& element, TextPlace begin) override;
  Result<TextPlace> vertices(TextPlace begin) override;
  Result<TextPlace> faces(TextPlace begin) override;
  Result<void> expect_end(TextPlace end) override;

 private:
  /// Items of one list in the file.
  struct ListSpan {
    std::uint64_t offset = 0;
    std::uint64_t count = 0;
  };

  /// Steps over the record at `position`; false if it reaches past the file's
  /// end or has a list of negative length. `list` is set for the list at
  /// property `list_property`.
  bool walk_record(const PlyElement& element, std::size_t list_property, std::uint64_t& position,
                   ListSpan& list) const noexcept;
  [[nodiscard]] MeshCorner corner(std::int64_t index) const noexcept;
  [[nodiscard]] Vec3 vertex(std::uint64_t index) const noexcept;
  /// Refuses a count of records that cannot fit behind `begin`.
  [[nodiscard]] Result<void> check_room(const PlyElement& element, std::uint64_t begin) const;
  [[nodiscard]] Error bad_record(const PlyElement& element, std::uint64_t record,
                                 std::uint64_t offset) const;

  MeshFile& file_;
  const PlyHeader& header_;
  MeshDelivery& delivery_;
  bool swap_;
  std::uint64_t vertices_begin_ = 0;
  std::uint64_t vertex_count_ = 0;  ///< 0 until vertices() has checked them
  std::uint64_t vertex_bytes_ = 0;
  std::array<std::uint64_t, 3> coordinate_offsets_ = {};
  std::array<PlyType, 3> coordinate_types_ = {};
};

}  // namespace planetree::octree
