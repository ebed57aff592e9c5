#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>

#include "octree/builder/mesh/stream/mesh_file.h"
#include "planetree/error.h"

namespace planetree::octree {

/// A part of a mesh file in memory, which moves to the bytes that are requested. Reading forward
/// reads no byte twice.
class MeshWindow {
 public:
  static constexpr std::size_t kWindowBytes = std::size_t{1} << 20;
  /// Maximum length of a record that record_at() reads as a whole.
  static constexpr std::uint64_t kRecordBytes = 4096;

  /// file          must outlive this.
  /// window_bytes  approximate size in memory; a longer request makes it larger.
  explicit MeshWindow(const MeshFile& file, std::size_t window_bytes = kWindowBytes)
      : file_(file), window_bytes_(std::max<std::size_t>(window_bytes, kRecordBytes)) {}

  /// The `bytes` bytes from `offset` on, which the file must have; valid until the next call. Null
  /// if they cannot be read: see failure().
  const std::byte* at(std::uint64_t offset, std::uint64_t bytes) {
    if (offset >= begin_ && offset <= end_ && bytes <= end_ - offset)
      return buffer_.get() + (offset - begin_);
    return fill(offset, bytes);
  }

  /// As at(), for the beginning of a record. Reads a record of up to kRecordBytes as a whole, so
  /// that its parts do not need further reads.
  const std::byte* record_at(std::uint64_t offset) {
    return at(offset, std::min(kRecordBytes, file_.size_bytes() - offset));
  }

  /// Number of bytes in memory from `offset` on. at() must have found some there.
  [[nodiscard]] std::uint64_t bytes_from(std::uint64_t offset) const { return end_ - offset; }

  /// The error of the last at() that returned null.
  [[nodiscard]] const Error& failure() const { return *failure_; }

 private:
  const std::byte* fill(std::uint64_t offset, std::uint64_t bytes);

  const MeshFile& file_;
  const std::size_t window_bytes_;
  std::unique_ptr<std::byte[]> buffer_;
  std::uint64_t capacity_ = 0;
  std::uint64_t begin_ = 0, end_ = 0;  ///< bounds of the window in the file
  std::optional<Error> failure_;
};

}  // namespace planetree::octree
