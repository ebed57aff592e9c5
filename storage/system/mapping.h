#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "planetree/error.h"
#include "storage/system/file_handle.h"

namespace planetree::storage {

/// A read-only memory map of a byte range of an open file.
///
/// The bytes are the file's own: they change when another process writes it,
/// and touching them after it was cut short kills the program (SIGBUS). So a
/// map is for copying from at once, at open, and then dropped; nothing that
/// has to hold is read from it twice. Bytes that the device cannot deliver are
/// found when the map is made, where the system can tell (Linux 5.14).
class Mapping {
 public:
  Mapping(Mapping&& other) noexcept;
  Mapping& operator=(Mapping&& other) noexcept;
  ~Mapping();

  /// file    must outlive the map's use of its FileCalls, not the map's bytes.
  /// offset  any; need not be aligned.
  /// bytes   at least 1; the range must lie within the file.
  /// errors  as file_error(): kReadFailed, kNoMemory and the like.
  static Result<Mapping> create(const FileHandle& file, std::uint64_t offset,
                                std::size_t bytes) noexcept;

  std::span<const std::byte> bytes() const noexcept { return bytes_; }

 private:
  Mapping() noexcept = default;
  void unmap() noexcept;

  FileCalls* calls_ = nullptr;
  void* address_ = nullptr;
  std::size_t mapped_bytes_ = 0;
  std::span<const std::byte> bytes_;
};

/// Copies a byte range of an open file through a map of it that lives no longer than the copy.
/// errors  as Mapping::create().
Result<void> copy_mapped(const FileHandle& file, std::uint64_t offset,
                         std::span<std::byte> out) noexcept;

}  // namespace planetree::storage
