#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>

#include "planetree/error.h"

namespace planetree::tools {

/// Refuses an output that is one of the inputs. "-" and empty paths are none.
///
/// errors  kBadArgument
Result<void> check_is_no_input(const std::filesystem::path& output,
                               std::span<const std::filesystem::path> inputs);

/// A file that gets its name only when it is complete. Bytes go to a file without a name in the
/// same folder, to which commit() gives the name. If anything fails before, the destination is
/// unchanged and nothing remains, even if the process is killed. Where the file system has no
/// unnamed files, and while a file is replaced, the file has a temporary name, which remains if the
/// process is killed.
///
/// "-" means standard output. Standard output, devices and pipes are written directly: they cannot
/// be replaced, so `may_replace` does not apply.
///
/// threads  one at a time
/// errors   texts do not name the file, because the caller knows the name that the user gave
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

  /// Reserves space for `bytes`, so that a full device is noticed before the work. Succeeds where
  /// the system cannot reserve.
  Result<void> reserve(std::uint64_t bytes);
  /// Appends all of `bytes`. Unbuffered: pieces should be large.
  Result<void> write(std::span<const std::byte> bytes);
  /// Whether bytes that were written may be written again: not those of standard output, a device
  /// or a pipe.
  [[nodiscard]] bool can_rewrite() const { return !destination_.empty(); }
  /// Writes bytes over the first ones of the file, which must have been written. Requires
  /// can_rewrite().
  Result<void> rewrite_front(std::span<const std::byte> bytes);
  /// Flushes the bytes to the device and names the file. The last call, made once. If it fails,
  /// the destination is unchanged.
  Result<void> commit();

  std::uint64_t bytes_written() const { return bytes_written_; }

 private:
  OutputFile() = default;
  Result<void> open_temporary();
  template <class Create>
  Result<void> with_temporary_name(const Create& create);
  Result<void> link_unnamed();
  Result<void> rename_temporary();

  int descriptor_ = -1;
  bool owns_descriptor_ = false;
  bool may_replace_ = false;
  std::filesystem::path destination_;  ///< empty if written directly
  std::filesystem::path temporary_;    ///< empty if there is none
  std::uint64_t bytes_written_ = 0;
};

}  // namespace planetree::tools
