#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>

#include "planetree/error.h"

namespace planetree::tools {

/// A file being written that bears its name only once it is whole: bytes go to a
/// temporary file in the same folder, which commit() renames. Whatever fails
/// before that, the destination is as it was, and the temporary file is removed.
///
/// "-" means standard output, and a destination that is a device or a pipe is
/// written directly: neither can be replaced, so neither needs permission to be.
///
/// threads  one at a time
/// errors   never name the file: the caller knows it by the name the user gave
class OutputFile {
 public:
  /// Opens the temporary file.
  ///
  /// may_replace  whether an existing file may be replaced
  /// errors       kAlreadyExists, kNotFound (no such folder), kPermission,
  ///              kNoSpace, kBadArgument (a folder), kWriteFailed
  static Result<OutputFile> create(const std::filesystem::path& path, bool may_replace);

  OutputFile(OutputFile&& other) noexcept;
  OutputFile& operator=(OutputFile&&) = delete;
  ~OutputFile();

  /// Claims room for a file of `bytes`, so that a full device is noticed before
  /// the work rather than after it. Where the system cannot tell, it succeeds.
  Result<void> reserve(std::uint64_t bytes);
  /// Appends all of `bytes`, unbuffered: hand over large pieces.
  Result<void> write(std::span<const std::byte> bytes);
  /// Brings the bytes to the device and gives the file its name. Call it once,
  /// last; if it fails the destination is as it was.
  Result<void> commit();

  std::uint64_t bytes_written() const { return bytes_written_; }

 private:
  OutputFile() = default;
  Result<void> open_temporary();
  Result<void> rename_temporary();

  int descriptor_ = -1;
  bool owns_descriptor_ = false;
  bool may_replace_ = false;
  std::filesystem::path destination_;
  std::filesystem::path temporary_;  ///< empty when written directly or committed
  std::uint64_t bytes_written_ = 0;
};

}  // namespace planetree::tools
