#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "octree/builder/mesh/stream/mesh_file.h"
#include "octree/builder/mesh/stream/mesh_scratch.h"
#include "octree/builder/mesh/stream/mesh_vertices.h"

namespace planetree::octree {

/// Records of a text file. They are stored as they are read: in memory up to a limit, then in a
/// temporary file.
class TextRecords final : public MeshRecords {
 public:
  /// file        the mesh; its size limits the number of records.
  /// held_bytes  maximum of the records in memory.
  /// scratch     must outlive this.
  TextRecords(const MeshFile& file, std::size_t record_bytes, std::uint64_t held_bytes,
              MeshScratch& scratch);

  /// Adds the next record. Call finish() after the last one, and read() only then.
  ///
  /// fill    (std::byte*): writes the record.
  /// errors  those of SpillFile::append().
  template <class Fill>
  Result<void> add(const Fill& fill) {
    const std::size_t at = last_.size();
    last_.resize(at + record_bytes_);
    fill(last_.data() + at);
    ++count_;
    return last_.size() < kAtOnceBytes ? Result<void>() : finish();
  }
  Result<void> finish();

  [[nodiscard]] std::uint64_t count() const override { return count_; }
  [[nodiscard]] std::size_t record_bytes() const override { return record_bytes_; }
  Result<void> read(std::uint64_t first, std::span<std::byte> out) override;

 private:
  static constexpr std::size_t kAtOnceBytes = std::size_t{64} << 10;

  const std::size_t record_bytes_;
  ScratchFile file_;
  std::vector<std::byte> last_;  ///< records that are not in file_ yet
  std::uint64_t count_ = 0;
};

}  // namespace planetree::octree
