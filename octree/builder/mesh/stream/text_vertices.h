#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "octree/builder/mesh/stream/corner_attributes.h"
#include "octree/builder/mesh/stream/mesh_file.h"
#include "octree/builder/mesh/stream/mesh_scratch.h"
#include "octree/builder/mesh/stream/mesh_vertices.h"
#include "octree/builder/mesh/stream/text_records.h"

namespace planetree::octree {

/// Vertices of a text file, which are stored as they are read.
class TextVertices final : public MeshVertices {
 public:
  /// file        the mesh.
  /// attributes  of the vertices.
  /// held_bytes  maximum of the vertices in memory.
  /// scratch     must outlive this.
  TextVertices(const MeshFile& file, bool float32, std::uint32_t attributes,
               std::uint64_t held_bytes, MeshScratch& scratch)
      : float32_(float32),
        attributes_(attributes),
        records_(file, MeshVertices::record_bytes(), held_bytes, scratch) {}
  /// Without attributes. Uses all memory that a text has for vertices.
  TextVertices(const MeshFile& file, bool float32, MeshScratch& scratch)
      : TextVertices(file, float32, 0, MeshScratch::text_bytes(scratch.memory_bytes()), scratch) {}

  /// Adds the next vertex. Call finish() after the last one, and read() only then.
  /// errors  those of SpillFile::append().
  Result<void> add(const Vec3& position, const CornerAttributes& attributes = {}) {
    return records_.add([&](std::byte* record) {
      put_position(position, float32_, record);
      put_attributes(attributes, attributes_, record + position_bytes());
    });
  }
  Result<void> finish() { return records_.finish(); }

  [[nodiscard]] std::uint64_t count() const override { return records_.count(); }
  [[nodiscard]] bool float32() const override { return float32_; }
  [[nodiscard]] std::uint32_t attributes() const override { return attributes_; }
  Result<void> read(std::uint64_t first, std::span<std::byte> out) override {
    return records_.read(first, out);
  }

 private:
  const bool float32_;
  const std::uint32_t attributes_;
  TextRecords records_;
};

}  // namespace planetree::octree
