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

/// A mesh file, open for reading. The size is taken once, at open; a file that has become
/// shorter since is an error where it is missed.
///
/// threads  any number may read.
class MeshFile {
 public:
  /// path    a regular file, possibly empty.
  /// calls   the system; must outlive this.
  /// errors  kNotFound, kPermission, kReadFailed; kBadInput: no regular file.
  static Result<MeshFile> open(const std::filesystem::path& path,
                               storage::FileCalls& calls = storage::FileCalls::real());

  [[nodiscard]] std::uint64_t size_bytes() const noexcept { return size_bytes_; }

  /// Fills `out` from `offset`, all of it within the size.
  /// errors  kReadFailed and the like; kBadInput: the file has become shorter.
  Result<void> read(std::uint64_t offset, std::span<std::byte> out) const;

  /// The file's first bytes as characters: `bytes`, or all if it has fewer.
  Result<std::string> prefix(std::uint64_t bytes) const;

 private:
  MeshFile(storage::FileHandle file, std::uint64_t size_bytes)
      : file_(std::move(file)), size_bytes_(size_bytes) {}

  storage::FileHandle file_;
  std::uint64_t size_bytes_ = 0;
};

}  // namespace planetree::octree
