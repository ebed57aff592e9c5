#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>

#include "octree/builder/mesh/stream/mesh_file.h"
#include "planetree/error.h"

namespace planetree::octree {

/// A stretch of a mesh file in memory, moved along as bytes are asked for. Who goes forward
/// reads no byte twice.
class MeshWindow {
 public:
  static constexpr std::size_t kWindowBytes = std::size_t{1} << 20;
  /// Of a record, at most, that record_at() brings in whole.
  static constexpr std::uint64_t kRecordBytes = 4096;

  /// file          must outlive this.
  /// window_bytes  about so many in memory, and more where more are asked for at a time.
  explicit MeshWindow(const MeshFile& file, std::size_t window_bytes = kWindowBytes)
      : file_(file), window_bytes_(std::max<std::size_t>(window_bytes, kRecordBytes)) {}

  /// `bytes` bytes from `offset` on, which the file must have, until the next call. Null: they
  /// cannot be read, failure() says why.
  const std::byte* at(std::uint64_t offset, std::uint64_t bytes) {
    if (offset >= begin_ && offset <= end_ && bytes <= end_ - offset)
      return buffer_.get() + (offset - begin_);
    return fill(offset, bytes);
  }

  /// Says that a record begins at `offset`: so it is not read again for its parts, if it is
  /// not long. Null as at().
  const std::byte* record_at(std::uint64_t offset) {
    return at(offset, std::min(kRecordBytes, file_.size_bytes() - offset));
  }

  /// How many bytes from `offset`, where at() found some, are in memory.
  [[nodiscard]] std::uint64_t bytes_from(std::uint64_t offset) const { return end_ - offset; }

  /// Why there was none; of at() that gave null.
  [[nodiscard]] const Error& failure() const { return *failure_; }

 private:
  const std::byte* fill(std::uint64_t offset, std::uint64_t bytes);

  const MeshFile& file_;
  const std::size_t window_bytes_;
  std::unique_ptr<std::byte[]> buffer_;
  std::uint64_t capacity_ = 0;
  std::uint64_t begin_ = 0, end_ = 0;  ///< of what is in memory, in the file
  std::optional<Error> failure_;
};

}  // namespace planetree::octree
