#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <utility>

#include "planetree/error.h"
#include "storage/system/file_calls.h"
#include "storage/system/file_handle.h"

namespace planetree::storage {

/// A new file that appears under its name either complete or not at all.
///
///   created    a file without a name (O_TMPFILE) in the destination's directory, which disappears
///              with the process; a file with a temporary name if the file system has no unnamed
///              files
///   written    at any offset, in any order
///   committed  synced, then given its name in one step, then the directory synced
///
/// If it is destroyed before it is committed, nothing remains. If the process is killed, nothing
/// remains either, with two exceptions: a file with a temporary name remains if the file system
/// has no unnamed files, or if the process is killed during the step that replaces an existing
/// file. Links at the destination are never followed: without `replace` a link counts as an
/// existing file, with `replace` the link itself is replaced.
/// threads  one at a time.
class NewFile {
 public:
  NewFile(NewFile&& other) noexcept;
  NewFile& operator=(NewFile&&) = delete;
  ~NewFile();

  /// Creates the file, not yet visible at `path`.
  ///
  /// path     destination of the file.
  /// replace  whether a regular file or a link at the destination may be replaced.
  /// calls    the system; must outlive the NewFile.
  /// errors   kBadArgument: no file name; kAlreadyExists; otherwise those of file_error().
  static Result<NewFile> create(const std::filesystem::path& path, bool replace,
                                FileCalls& calls = FileCalls::real());

  /// errors  those of file_error(), among them kNoSpace.
  Result<void> write_at(std::uint64_t offset, std::span<const std::byte> bytes) const noexcept;

  /// Gives the file another name in the same directory. Call it before commit().
  void rename(std::string name) noexcept { name_ = std::move(name); }

  /// The file, open for reading and writing until it is committed. It belongs to this.
  const FileHandle& file() const noexcept { return file_; }

  /// Makes the file durable, then visible. Call it once.
  /// errors  kAlreadyExists: the name was taken in the meantime; otherwise those of file_error().
  ///         After an error the destination is unchanged, with one exception: if the directory
  ///         cannot be synced, the destination is the new file, complete, and the error says so.
  Result<void> commit();

 private:
  NewFile() noexcept = default;
  FileCalls& calls() const noexcept { return directory_.calls(); }
  Result<void> open_unnamed() noexcept;
  Result<void> open_named();
  Result<void> publish_unnamed();
  Result<void> publish_named() noexcept;
  Result<void> link_under_temporary_name();
  Result<void> rename_over_destination() noexcept;
  Result<void> sync_directory() noexcept;
  void discard() noexcept;

  FileHandle directory_;
  FileHandle file_;
  std::string name_;
  std::string temporary_name_;  // empty if the file has none
  bool replace_ = false;
};

}  // namespace planetree::storage
