#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>

#include "planetree/error.h"
#include "storage/file/file_layout.h"
#include "storage/system/file_calls.h"

namespace planetree::storage {

/// Where the bytes of a model are written to: one file, or several. They appear either complete or
/// not at all.
///
/// threads  one at a time
class ModelOutput {
 public:
  static constexpr std::size_t kMaxWriteBytes = std::size_t{1} << 20;

  virtual ~ModelOutput() = default;

  /// Call it once, before all others.
  ///
  /// pages_start  offset of the first page
  virtual Result<void> begin(std::uint64_t pages_start) = 0;
  /// Length of a write that this prefers, at most kMaxWriteBytes. A longer page is written by
  /// itself.
  virtual std::size_t write_bytes() const noexcept { return kMaxWriteBytes; }
  /// Writes bytes. Those from the first page on come in the order of their offsets and without
  /// gaps; each call has whole pages. Those before the first page come in any order.
  virtual Result<void> write_at(std::uint64_t offset, std::span<const std::byte> bytes) = 0;
  /// Makes the output visible, when all is written. Call it once.
  ///
  /// header  as written
  /// pages   all of them
  virtual Result<void> commit(const FileHeader& header, std::span<const DirectoryPage> pages) = 0;
};

/// Starts one file; see NewFile.
///
/// errors  those of NewFile::create()
Result<std::unique_ptr<ModelOutput>> new_model_file(const std::filesystem::path& path, bool replace,
                                                    FileCalls& calls = FileCalls::real());

}  // namespace planetree::storage
