#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "octree/attributes/attribute_page.h"
#include "octree/builder/mesh/stream/triangle_sink.h"
#include "planetree/error.h"
#include "storage/spill/spill_file.h"

namespace planetree::octree {

/// The attributes of all indices of a mesh, in a SpillFile: records of
/// AttributeShape::extra_bytes() each, in the order of indices. A record has colours, uvs and
/// value, as far as they are kept. An index without a triangle has zeros.
struct SpooledAttributes {
  std::vector<std::uint64_t> offsets;  ///< in the file, of the blocks
  std::uint64_t count = 0;             ///< number of records
  std::uint64_t record_bytes = 0;      ///< 0: nothing is spooled

  static constexpr std::uint64_t kBlockRecords = 4096;
  /// Number of records in a block.
  std::uint64_t block_records(std::uint64_t block) const;
  /// Reads the records from `first` on, as many as fit in `out`.
  /// errors  those of SpillFile::read().
  Result<void> read(const storage::SpillFile& file, std::uint64_t first,
                    std::span<std::byte> out) const;
};

/// Stores the attributes of a mesh that is read, and passes everything else on.
///
/// threads  one at a time.
class AttributeSpool final : public TriangleSink {
 public:
  /// shape  has attributes beside links.
  /// next   receives triangles; it and `file` must outlive this.
  AttributeSpool(AttributeShape shape, TriangleSink& next, storage::SpillFile& file);

  Result<void> triangle(std::uint64_t index, const std::array<Vec3, 3>& corners) override {
    return next_.triangle(index, corners);
  }
  Result<void> attributes(const TriangleAttributes& attributes) override;
  void skipped(std::uint64_t first_index, std::uint64_t count, const SkippedRecord& why) override;
  Result<void> progress(std::uint64_t bytes_done, std::uint64_t bytes_total) override;

  /// Ends the spool. Call it once, after the last triangle.
  /// errors  those of SpillFile::append().
  Result<SpooledAttributes> finish();

 private:
  std::byte* add();
  Result<void> store_block();

  const AttributeShape shape_;
  TriangleSink& next_;
  storage::SpillFile& file_;
  std::vector<std::byte> block_;
  std::size_t block_bytes_ = 0;  ///< of block_, in use
  SpooledAttributes spooled_;
  Result<void> stored_;  ///< skipped() cannot return an error
};

}  // namespace planetree::octree
