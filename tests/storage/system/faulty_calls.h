#pragma once

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <optional>
#include <string>

#include "storage/system/file_calls.h"

namespace planetree::storage {

/// Returns a device with this number of free blocks.
inline struct statvfs device_with_free(std::uint64_t free_blocks, std::uint64_t block_bytes = 1) {
  struct statvfs device = {};
  device.f_bsize = device.f_frsize = block_bytes;
  device.f_bavail = free_blocks;
  device.f_blocks = device.f_bfree = free_blocks + 1000;
  return device;
}

/// The system with one faulty call: number `fault_at` of those that the fault can affect.
class FaultyCalls final : public FileCalls {
 public:
  enum class Fault : std::uint8_t {
    kNone,
    kError,      ///< any call fails with errno `number`
    kInterrupt,  ///< a call that a signal can interrupt does nothing and fails with EINTR
    kShort,      ///< a read or write transfers half of its bytes
    kKill,       ///< the process is killed before the call
  };

  Fault fault = Fault::kNone;
  int number = EIO;                      ///< errno of kError
  int fault_at = 0;                      ///< index of the faulty call, from 0
  bool every = false;                    ///< all calls from there on, rather than one
  bool lacks_unnamed_files = false;      ///< a file system without O_TMPFILE
  bool no_proc = false;                  ///< a system without /proc
  bool no_noreplace = false;             ///< a file system that renames only with replacement
  std::optional<struct statvfs> device;  ///< status reported for every device, if set

  bool happened() const { return !failed_call_.empty(); }
  const std::string& failed_call() const { return failed_call_; }
  int fsync_count() const { return fsync_count_; }

  int openat(int directory, const char* path, int flags, mode_t mode) noexcept override {
    if (lacks_unnamed_files && (flags & O_TMPFILE) == O_TMPFILE) return failed(EOPNOTSUPP);
    if (fails("openat", true)) return failed(number_);
    return FileCalls::openat(directory, path, flags, mode);
  }
  int close(int descriptor) noexcept override {
    const int outcome = FileCalls::close(descriptor);
    return fails("close", false) ? failed(number_) : outcome;
  }
  int fstat(int descriptor, struct stat* status) noexcept override {
    return fails("fstat", false) ? failed(number_) : FileCalls::fstat(descriptor, status);
  }
  int fstatat(int directory, const char* path, struct stat* status, int flags) noexcept override {
    if (no_proc && std::strncmp(path, "/proc/", 6) == 0) return failed(ENOENT);
    if (fails("fstatat", false)) return failed(number_);
    return FileCalls::fstatat(directory, path, status, flags);
  }
  int statvfs(const char* path, struct statvfs* found) noexcept override {
    if (fails("statvfs", false)) return failed(number_);
    if (!device) return FileCalls::statvfs(path, found);
    *found = *device;
    return 0;
  }
  ssize_t pread(int descriptor, void* out, std::size_t bytes, off_t offset) noexcept override {
    if (fails("pread", true)) return failed(number_);
    return FileCalls::pread(descriptor, out, shortened(bytes), offset);
  }
  ssize_t pwrite(int descriptor, const void* in, std::size_t bytes,
                 off_t offset) noexcept override {
    if (fails("pwrite", true)) return failed(number_);
    return FileCalls::pwrite(descriptor, in, shortened(bytes), offset);
  }
  int fsync(int descriptor) noexcept override {
    ++fsync_count_;
    (void)descriptor;  // no test here cuts the power, and syncing a disk is slow
    return fails("fsync", false) ? failed(number_) : 0;
  }
  int fdatasync(int descriptor) noexcept override {
    (void)descriptor;
    return fails("fdatasync", false) ? failed(number_) : 0;
  }
  int ftruncate(int descriptor, off_t bytes) noexcept override {
    return fails("ftruncate", true) ? failed(number_) : FileCalls::ftruncate(descriptor, bytes);
  }
  int flock(int descriptor, int operation) noexcept override {
    return fails("flock", true) ? failed(number_) : FileCalls::flock(descriptor, operation);
  }
  int mkdirat(int directory, const char* path, mode_t mode) noexcept override {
    return fails("mkdirat", false) ? failed(number_) : FileCalls::mkdirat(directory, path, mode);
  }
  int linkat(int old_directory, const char* old_path, int new_directory, const char* new_path,
             int flags) noexcept override {
    if (fails("linkat", false)) return failed(number_);
    return FileCalls::linkat(old_directory, old_path, new_directory, new_path, flags);
  }
  int renameat2(int old_directory, const char* old_path, int new_directory, const char* new_path,
                unsigned flags) noexcept override {
    if (no_noreplace && (flags & RENAME_NOREPLACE) != 0) return failed(EINVAL);
    if (fails("renameat2", false)) return failed(number_);
    return FileCalls::renameat2(old_directory, old_path, new_directory, new_path, flags);
  }
  int unlinkat(int directory, const char* path, int flags) noexcept override {
    // A full disk still permits removing names.
    if (!every && fails("unlinkat", false)) return failed(number_);
    return FileCalls::unlinkat(directory, path, flags);
  }
  void* mmap(std::size_t bytes, int protection, int flags, int descriptor,
             off_t offset) noexcept override {
    if (fails("mmap", false)) {
      errno = number_;
      return MAP_FAILED;
    }
    return FileCalls::mmap(bytes, protection, flags, descriptor, offset);
  }
  int munmap(void* address, std::size_t bytes) noexcept override {
    const int outcome = FileCalls::munmap(address, bytes);
    return fails("munmap", false) ? failed(number_) : outcome;
  }
  int madvise(void* address, std::size_t bytes, int advice) noexcept override {
    if (fails("madvise", true)) return failed(number_);
    return FileCalls::madvise(address, bytes, advice);
  }

 private:
  // Counts the calls that the fault can affect; true if this one fails.
  bool fails(const char* call, bool interruptible) noexcept {
    if (fault == Fault::kNone || fault == Fault::kShort) return false;
    if (fault == Fault::kInterrupt && !interruptible) return false;
    const int at = count_++;
    if (at != fault_at && !(every && at > fault_at && fault != Fault::kInterrupt)) return false;
    if (fault == Fault::kKill) ::raise(SIGKILL);
    number_ = fault == Fault::kInterrupt ? EINTR : number;
    failed_call_ = call;
    return true;
  }

  std::size_t shortened(std::size_t bytes) noexcept {
    if (fault != Fault::kShort) return bytes;
    const int at = count_++;
    if (at != fault_at && !(every && at > fault_at)) return bytes;
    failed_call_ = "short";
    return std::max<std::size_t>(bytes / 2, 1);
  }

  static int failed(int number) noexcept {
    errno = number;
    return -1;
  }

  int count_ = 0;
  int number_ = 0;
  int fsync_count_ = 0;
  std::string failed_call_;
};

}  // namespace planetree::storage
