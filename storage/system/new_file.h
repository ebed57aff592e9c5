#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "planetree/error.h"
#include "storage/system/file_calls.h"
#include "storage/system/file_handle.h"

namespace planetree::storage {

/// A file that appears under its name complete or not at all.
///
///   created    a file without a name (O_TMPFILE) in the destination's directory, which vanishes
///              with the process; where that cannot be had, one with a temporary name
///   written    at any offset, in any order
///   committed  synced, then given its name in one step, then the directory synced
///
/// Destroyed before it is committed, it leaves nothing behind. A process
/// killed leaves nothing either, but for a temporary name where the file
/// system offers no file without one, or within the one step that replaces an
/// existing file. Links at the destination are never followed: without
/// `replace` they count as existing, with it the link itself is replaced.
/// threads  one at a time.
class NewFile {
 public:
  NewFile(NewFile&& other) noexcept;
  NewFile& operator=(NewFile&&) = delete;
  ~NewFile();

  /// path    where the file shall appear.
  /// replace  whether a regular file or a link there may be replaced.
  /// calls   the system; must outlive the NewFile.
  /// errors  kBadArgument: no file name; kAlreadyExists; else as file_error().
  static Result<NewFile> create(const std::filesystem::path& path, bool replace,
                                FileCalls& calls = FileCalls::real());

  /// errors  as file_error(), kNoSpace among them.
  Result<void> write_at(std::uint64_t offset, std::span<const std::byte> bytes) const noexcept;

  /// Makes the file durable, then visible. To be called once.
  /// errors  kAlreadyExists: something took the name meanwhile; else as file_error(). The
  ///         destination is then as it was. Only where the directory cannot be synced it already
  ///         is the new file, whole, and the error says so.
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
  std::string temporary_name_;  // empty while the file has none
  bool replace_ = false;
};

}  // namespace planetree::storage
