#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

#include "planetree/error.h"
#include "storage/system/file_calls.h"
#include "storage/system/file_handle.h"

namespace planetree::octree {

class ScratchFile;

/// A mesh file that is open for reading. Its size is taken once, when it is opened. If the file
/// becomes shorter, reading the missing bytes is an error. The content of a compressed file is a
/// mesh file too (packing.h).
///
/// threads  any number may read.
class MeshFile {
 public:
  /// path    a regular file, possibly empty.
  /// calls   the system; must outlive this.
  /// errors  kNotFound, kPermission, kReadFailed; kBadInput: not a regular file.
  static Result<MeshFile> open(const std::filesystem::path& path,
                               storage::FileCalls& calls = storage::FileCalls::real());

  /// The content of a compressed file.
  ///
  /// content  its MeshScratch must outlive this.
  MeshFile(std::unique_ptr<ScratchFile> content, std::uint64_t size_bytes);
  MeshFile(MeshFile&& other) noexcept;
  MeshFile& operator=(MeshFile&& other) noexcept;
  ~MeshFile();

  [[nodiscard]] std::uint64_t size_bytes() const noexcept { return size_bytes_; }

  /// Fills `out` with the bytes from `offset` on. They must lie within size_bytes().
  /// errors  kReadFailed and others of FileHandle::read_at(); kBadInput: the file became shorter.
  Result<void> read(std::uint64_t offset, std::span<std::byte> out) const;

  /// The file's first `bytes` bytes as characters, or all if it has fewer.
  Result<std::string> prefix(std::uint64_t bytes) const;

 private:
  MeshFile(storage::FileHandle file, std::uint64_t size_bytes);

  storage::FileHandle file_;
  std::unique_ptr<ScratchFile> content_;  ///< if any, read instead of the file
  std::uint64_t size_bytes_ = 0;
};

}  // namespace planetree::octree
