#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "planetree/error.h"
#include "storage/system/file_calls.h"
#include "storage/system/file_handle.h"

namespace planetree::octree {

/// A mesh file that is open for reading. Its size is taken once, when it is opened. If the file
/// becomes shorter, reading the missing bytes is an error.
///
/// threads  any number may read.
class MeshFile {
 public:
  /// path    a regular file, possibly empty.
  /// calls   the system; must outlive this.
  /// errors  kNotFound, kPermission, kReadFailed; kBadInput: not a regular file.
  static Result<MeshFile> open(const std::filesystem::path& path,
                               storage::FileCalls& calls = storage::FileCalls::real());

  [[nodiscard]] std::uint64_t size_bytes() const noexcept { return size_bytes_; }

  /// Fills `out` with the bytes from `offset` on. They must lie within size_bytes().
  /// errors  kReadFailed and others of FileHandle::read_at(); kBadInput: the file became shorter.
  Result<void> read(std::uint64_t offset, std::span<std::byte> out) const;

  /// The file's first `bytes` bytes as characters, or all if it has fewer.
  Result<std::string> prefix(std::uint64_t bytes) const;

 private:
  MeshFile(storage::FileHandle file, std::uint64_t size_bytes)
      : file_(std::move(file)), size_bytes_(size_bytes) {}

  storage::FileHandle file_;
  std::uint64_t size_bytes_ = 0;
};

}  // namespace planetree::octree
