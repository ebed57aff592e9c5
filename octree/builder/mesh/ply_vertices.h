#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "octree/builder/mesh/ply_attributes.h"
#include "octree/builder/mesh/ply_header.h"
#include "octree/builder/mesh/stream/mesh_file.h"
#include "octree/builder/mesh/stream/mesh_vertices.h"

namespace planetree::octree {

/// The vertices of a binary PLY body, read from the file. Records have one size, so that their
/// offsets are computed.
class PlyVertices final : public MeshVertices {
 public:
  /// All arguments must outlive this.
  PlyVertices(const MeshFile& file, const PlyHeader& header, const PlyAttributes& attributes,
              bool swap);

  /// Sets where the vertices are. The file must have all of them.
  void set(std::uint64_t offset, std::uint64_t count) {
    begin_ = offset;
    count_ = count;
  }
  [[nodiscard]] std::uint64_t file_record_bytes() const { return record_bytes_; }

  [[nodiscard]] std::uint64_t count() const override { return count_; }
  [[nodiscard]] bool float32() const override { return float32_; }
  [[nodiscard]] std::uint32_t attributes() const override { return attributes_.of_vertices; }
  Result<void> read(std::uint64_t first, std::span<std::byte> out) override;

 private:
  /// A number of a record.
  struct Number {
    std::uint64_t offset = 0;
    ScalarType type = ScalarType::kFloat32;
  };

  [[nodiscard]] double load(const std::byte* record, const Number& number) const {
    return load_real(number.type, record + number.offset, swap_);
  }
  [[nodiscard]] Vec3 position(const std::byte* record) const;
  [[nodiscard]] CornerAttributes attributes_of(const std::byte* record) const;

  const MeshFile& file_;
  const PlyHeader& header_;
  const PlyAttributes& attributes_;
  const bool swap_;
  const bool float32_;
  std::uint64_t begin_ = 0, count_ = 0;
  std::uint64_t record_bytes_ = 0;
  std::array<Number, 3> coordinates_ = {};
  std::vector<Number> numbers_;     ///< of attributes
  bool plain_ = true;               ///< records have the form that MeshVertices has
  std::vector<std::byte> records_;  ///< records as in the file
};

}  // namespace planetree::octree
