#pragma once

#include <linux/time_types.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <sys/types.h>
#include <sys/uio.h>

#include <cstddef>

struct io_uring;
struct io_uring_cqe;

/// The system calls that storage makes. Tests override them to make any of them fail.
///
/// Each function does what the system call of its name does, returns what that returns, and sets
/// errno. The base class calls the real system. It has no state, so any thread may use it.
namespace planetree::storage {

class FileCalls {
 public:
  virtual ~FileCalls() = default;

  virtual int openat(int directory, const char* path, int flags, mode_t mode) noexcept;
  virtual int close(int descriptor) noexcept;
  virtual int fstat(int descriptor, struct stat* status) noexcept;
  virtual int fstatat(int directory, const char* path, struct stat* status, int flags) noexcept;
  virtual int statvfs(const char* path, struct statvfs* space) noexcept;
  virtual ssize_t pread(int descriptor, void* out, std::size_t bytes, off_t offset) noexcept;
  virtual ssize_t preadv2(int descriptor, const iovec* parts, int part_count, off_t offset,
                          int flags) noexcept;
  virtual int posix_fadvise(int descriptor, off_t offset, off_t bytes, int advice) noexcept;
  virtual ssize_t pwrite(int descriptor, const void* in, std::size_t bytes, off_t offset) noexcept;
  virtual int fsync(int descriptor) noexcept;
  virtual int fdatasync(int descriptor) noexcept;
  virtual int ftruncate(int descriptor, off_t bytes) noexcept;
  virtual int flock(int descriptor, int operation) noexcept;
  virtual int mkdirat(int directory, const char* path, mode_t mode) noexcept;
  virtual int linkat(int old_directory, const char* old_path, int new_directory,
                     const char* new_path, int flags) noexcept;
  virtual int renameat2(int old_directory, const char* old_path, int new_directory,
                        const char* new_path, unsigned flags) noexcept;
  virtual int unlinkat(int directory, const char* path, int flags) noexcept;
  virtual void* mmap(std::size_t bytes, int protection, int flags, int descriptor,
                     off_t offset) noexcept;
  virtual int munmap(void* address, std::size_t bytes) noexcept;
  virtual int madvise(void* address, std::size_t bytes, int advice) noexcept;

  /// Functions of liburing: they return error numbers negated and do not set errno.
  virtual int io_uring_queue_init(unsigned entries, io_uring* ring, unsigned flags) noexcept;
  virtual int io_uring_submit_and_wait_timeout(io_uring* ring, io_uring_cqe** completion,
                                               unsigned count,
                                               __kernel_timespec* max_wait) noexcept;
  virtual void io_uring_queue_exit(io_uring* ring) noexcept;

  /// The real system; lives as long as the program.
  static FileCalls& real() noexcept;
};

}  // namespace planetree::storage
