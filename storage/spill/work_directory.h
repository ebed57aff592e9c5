#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "planetree/error.h"
#include "storage/system/file_calls.h"
#include "storage/system/file_handle.h"

namespace planetree::storage {

/// A directory in which one process at a time keeps files for a later process. remove() deletes it
/// when it is no longer needed. The directory and its files must belong to the current user, and
/// no other user may be able to write to them. Symbolic links in place of the directory or its
/// files are not followed.
///
/// threads  one at a time.
class WorkDirectory {
 public:
  WorkDirectory(WorkDirectory&&) noexcept = default;

  /// Creates the directory or opens an existing one, and locks it. The lock ends when the object is
  /// destroyed or the process ends in any way. Waits up to a second for another process to release
  /// the lock.
  ///
  /// path    path of the directory; its parent must exist.
  /// calls   the system; must outlive this object.
  /// errors  kAlreadyExists: another process has locked the directory, or something else has its
  ///         name; kPermission: it belongs to another user, or other users can write to it;
  ///         otherwise those of file_error().
  static Result<WorkDirectory> open(const std::filesystem::path& path,
                                    FileCalls& calls = FileCalls::real());

  /// Opens a file for reading and writing; creates it if it does not exist.
  /// errors  those of open().
  Result<FileHandle> open_file(const char* name);

  /// Makes the names of the files and of the directory durable.
  /// errors  those of file_error().
  Result<void> sync_names() const;

  /// Removes all files opened with open_file(), then the directory. A directory with other files in
  /// it remains. Call it once, as the last call.
  /// errors  those of file_error().
  Result<void> remove();

 private:
  WorkDirectory() noexcept = default;
  Result<bool> lock();

  FileHandle parent_;
  std::string name_;
  FileHandle directory_;
  FileHandle lock_;
  std::vector<std::string> files_;
};

}  // namespace planetree::storage
