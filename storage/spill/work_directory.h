#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "planetree/error.h"
#include "storage/system/file_calls.h"
#include "storage/system/file_handle.h"

namespace planetree::storage {

/// A directory in which one process at a time keeps files for a later one, to be removed when
/// nobody needs them. It and what is in it belong to this user, who alone can write there;
/// links in its place or its files' are not followed.
///
/// threads  one at a time.
class WorkDirectory {
 public:
  WorkDirectory(WorkDirectory&&) noexcept = default;

  /// Makes the directory, or takes the one that is there. It is locked until this is destroyed,
  /// however the process ends.
  ///
  /// path    its parent must exist.
  /// calls   the system; must outlive this.
  /// errors  kAlreadyExists: another process has it, for a second at least, or something else has
  /// its name;
  ///         kPermission: it is another user's; else as file_error().
  static Result<WorkDirectory> open(const std::filesystem::path& path,
                                    FileCalls& calls = FileCalls::real());

  /// Opens a file for reading and writing; makes it if there is none.
  /// errors  as open().
  Result<FileHandle> open_file(const char* name);

  /// Makes the names of the files, and the directory's own, durable.
  Result<void> sync_names() const;

  /// Removes the files that were opened, then the directory. Call it once, and nothing else
  /// then.
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
