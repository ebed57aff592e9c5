#include "storage/spill/work_directory.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <thread>
#include <utility>

#include "storage/system/file_error.h"

namespace planetree::storage {
namespace {

constexpr const char* kLockName = "lock";
constexpr mode_t kDirectoryMode = 0700;
constexpr mode_t kFileMode = 0600;  // other users must not read the files
constexpr int kMaxAttempts = 100;
// A killed process keeps its lock until the system has ended it.
constexpr int kMaxWaits = 20;
constexpr std::chrono::milliseconds kWait(50);
// O_NONBLOCK: opening a pipe in place of the file must not block.
constexpr int kFileFlags = O_RDWR | O_CREAT | O_NOFOLLOW | O_NONBLOCK;

Error work_error(const char* what) noexcept { return file_error(errno, FileAction::kWrite, what); }

Error conflict_error(ErrorCode code, const char* cause) noexcept {
  return make_error(code, Error::kNowhere, Error::kNowhere,
                    "%s; remove it or choose another directory for temporary files", cause);
}

// Refuses a directory or file that other users can write to: they could make this process read and
// truncate files that they choose.
Result<void> check_owned(const FileHandle& handle, bool directory) noexcept {
  struct stat status;
  if (handle.calls().fstat(handle.descriptor(), &status) != 0)
    return work_error("examine the work directory");
  if (status.st_uid != ::geteuid() || (status.st_mode & (S_IWGRP | S_IWOTH)) != 0)
    return conflict_error(ErrorCode::kPermission, "other users can write to the work directory");
  if (!directory && (!S_ISREG(status.st_mode) || status.st_nlink > 1))
    return conflict_error(ErrorCode::kAlreadyExists,
                          "the work directory has files that are not those of a build");
  return {};
}

Error directory_error() noexcept {
  if (errno == ENOTDIR || errno == ELOOP)
    return conflict_error(ErrorCode::kAlreadyExists,
                          "the work directory's name is that of a file or link");
  return work_error("open the work directory");
}

Error file_open_error() noexcept {
  if (errno == ELOOP || errno == EISDIR || errno == ENXIO)
    return conflict_error(ErrorCode::kAlreadyExists,
                          "the work directory has files that are not those of a build");
  return work_error("open a file in the work directory");
}

// Returns false on failure; errno then says why.
bool take_lock(const FileHandle& file) noexcept {
  for (int waits = 0;;) {
    if (file.calls().flock(file.descriptor(), LOCK_EX | LOCK_NB) == 0) return true;
    if (errno == EINTR) continue;
    if (errno != EWOULDBLOCK || waits++ == kMaxWaits) return false;
    std::this_thread::sleep_for(kWait);
  }
}

Result<void> sync_directory(const FileHandle& directory) noexcept {
  const int outcome = directory.calls().fsync(directory.descriptor());
  // Some file systems cannot sync directories and report EINVAL or EROFS.
  if (outcome == 0 || errno == EINVAL || errno == EROFS) return {};
  return work_error("make the work directory durable");
}

}  // namespace

Result<WorkDirectory> WorkDirectory::open(const std::filesystem::path& path, FileCalls& calls) {
  WorkDirectory work;
  work.name_ = path.filename().string();
  const std::filesystem::path parent = path.has_parent_path() ? path.parent_path() : ".";
  work.parent_ = FileHandle::open(calls, AT_FDCWD, parent.c_str(), O_RDONLY | O_DIRECTORY);
  if (!work.parent_.is_open()) return work_error("open the directory for temporary files");
  // Repeat while other processes, which have finished with the directory, remove it.
  for (int attempt = 0; attempt < kMaxAttempts; ++attempt) {
    if (calls.mkdirat(work.parent_.descriptor(), work.name_.c_str(), kDirectoryMode) != 0 &&
        errno != EEXIST)
      return work_error("make the work directory");
    work.directory_ = FileHandle::open(calls, work.parent_.descriptor(), work.name_.c_str(),
                                       O_RDONLY | O_DIRECTORY | O_NOFOLLOW);
    if (!work.directory_.is_open()) {
      if (errno == ENOENT) continue;
      return directory_error();
    }
    if (const auto owned = check_owned(work.directory_, true); !owned) return owned.error();
    const auto locked = work.lock();
    if (!locked) return locked.error();
    if (*locked) return work;
  }
  errno = EBUSY;
  return work_error("open the work directory");
}

// Returns false if the directory or the locked file no longer exists under its name.
Result<bool> WorkDirectory::lock() {
  FileCalls& calls = directory_.calls();
  lock_ = FileHandle::open(calls, directory_.descriptor(), kLockName, kFileFlags, kFileMode);
  if (!lock_.is_open()) {
    if (errno == ENOENT) return false;
    return file_open_error();
  }
  if (const auto owned = check_owned(lock_, false); !owned) return owned.error();
  if (!take_lock(lock_)) {
    if (errno != EWOULDBLOCK) return work_error("lock the work directory");
    return make_error(ErrorCode::kAlreadyExists, Error::kNowhere, Error::kNowhere,
                      "another process runs the same build; wait for it or name another output");
  }
  struct stat locked, named;
  if (calls.fstat(lock_.descriptor(), &locked) != 0) return work_error("examine the lock");
  if (calls.fstatat(directory_.descriptor(), kLockName, &named, AT_SYMLINK_NOFOLLOW) != 0) {
    if (errno == ENOENT) return false;
    return work_error("examine the lock");
  }
  return locked.st_ino == named.st_ino && locked.st_dev == named.st_dev;
}

Result<FileHandle> WorkDirectory::open_file(const char* name) {
  FileHandle file =
      FileHandle::open(directory_.calls(), directory_.descriptor(), name, kFileFlags, kFileMode);
  if (!file.is_open()) return file_open_error();
  if (const auto owned = check_owned(file, false); !owned) return owned.error();
  files_.emplace_back(name);
  return file;
}

Result<void> WorkDirectory::sync_names() const {
  if (const auto synced = sync_directory(directory_); !synced) return synced;
  return sync_directory(parent_);
}

Result<void> WorkDirectory::remove() {
  FileCalls& calls = directory_.calls();
  // A second attempt covers a transient failure, because nothing else removes the file.
  const auto removed = [&calls](const FileHandle& from, const std::string& name, int flags) {
    for (int attempt = 0; attempt < 2; ++attempt)
      if (calls.unlinkat(from.descriptor(), name.c_str(), flags) == 0 || errno == ENOENT)
        return true;
    return false;
  };
  // The lock file goes last. Once it is gone, the other files may belong to the next process.
  files_.emplace_back(kLockName);
  for (const std::string& name : files_)
    if (!removed(directory_, name, 0)) return work_error("remove a file of the work directory");
  if (removed(parent_, name_, AT_REMOVEDIR) || errno == ENOTEMPTY) return {};
  return work_error("remove the work directory");
}

}  // namespace planetree::storage
