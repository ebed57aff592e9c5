#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "planetree/error.h"
#include "storage/system/file_handle.h"

namespace planetree::storage {

/// A read-only memory map of a byte range of an open file.
///
/// The bytes are the file's own: they change when another process writes the file, and access to
/// them after the file was shortened kills the program (SIGBUS). So use a map only to copy the
/// bytes once, right after opening the file, and then destroy it. Do not read a byte twice where
/// both reads must agree. Since Linux 5.14, create() reports bytes that the device cannot deliver.
class Mapping {
 public:
  Mapping(Mapping&& other) noexcept;
  Mapping& operator=(Mapping&&) = delete;
  ~Mapping();

  /// Maps a byte range.
  ///
  /// file    may be closed before the map is destroyed; its FileCalls must outlive the map.
  /// offset  any; need not be aligned.
  /// bytes   at least 1; the range must lie within the file.
  /// errors  those of file_error(), such as kReadFailed and kNoMemory.
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

/// Copies a byte range of an open file. Maps the range only for the time of the copy.
/// errors  those of Mapping::create().
Result<void> copy_mapped(const FileHandle& file, std::uint64_t offset,
                         std::span<std::byte> out) noexcept;

}  // namespace planetree::storage
