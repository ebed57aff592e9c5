#include "storage/system/file_calls.h"

#include <fcntl.h>
#include <liburing.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstdio>

namespace planetree::storage {

int FileCalls::openat(int directory, const char* path, int flags, mode_t mode) noexcept {
  return ::openat(directory, path, flags, mode);
}

int FileCalls::close(int descriptor) noexcept { return ::close(descriptor); }

int FileCalls::fstat(int descriptor, struct stat* status) noexcept {
  return ::fstat(descriptor, status);
}

int FileCalls::fstatat(int directory, const char* path, struct stat* status, int flags) noexcept {
  return ::fstatat(directory, path, status, flags);
}

int FileCalls::statvfs(const char* path, struct statvfs* space) noexcept {
  return ::statvfs(path, space);
}

ssize_t FileCalls::pread(int descriptor, void* out, std::size_t bytes, off_t offset) noexcept {
  return ::pread(descriptor, out, bytes, offset);
}

ssize_t FileCalls::preadv2(int descriptor, const iovec* parts, int part_count, off_t offset,
                           int flags) noexcept {
  return ::preadv2(descriptor, parts, part_count, offset, flags);
}

int FileCalls::posix_fadvise(int descriptor, off_t offset, off_t bytes, int advice) noexcept {
  return ::posix_fadvise(descriptor, offset, bytes, advice);
}

ssize_t FileCalls::pwrite(int descriptor, const void* in, std::size_t bytes,
                          off_t offset) noexcept {
  return ::pwrite(descriptor, in, bytes, offset);
}

int FileCalls::fsync(int descriptor) noexcept { return ::fsync(descriptor); }

int FileCalls::fdatasync(int descriptor) noexcept { return ::fdatasync(descriptor); }

int FileCalls::ftruncate(int descriptor, off_t bytes) noexcept {
  return ::ftruncate(descriptor, bytes);
}

int FileCalls::flock(int descriptor, int operation) noexcept {
  return ::flock(descriptor, operation);
}

int FileCalls::mkdirat(int directory, const char* path, mode_t mode) noexcept {
  return ::mkdirat(directory, path, mode);
}

int FileCalls::linkat(int old_directory, const char* old_path, int new_directory,
                      const char* new_path, int flags) noexcept {
  return ::linkat(old_directory, old_path, new_directory, new_path, flags);
}

int FileCalls::renameat2(int old_directory, const char* old_path, int new_directory,
                         const char* new_path, unsigned flags) noexcept {
  return ::renameat2(old_directory, old_path, new_directory, new_path, flags);
}

int FileCalls::unlinkat(int directory, const char* path, int flags) noexcept {
  return ::unlinkat(directory, path, flags);
}

void* FileCalls::mmap(std::size_t bytes, int protection, int flags, int descriptor,
                      off_t offset) noexcept {
  return ::mmap(nullptr, bytes, protection, flags, descriptor, offset);
}

int FileCalls::munmap(void* address, std::size_t bytes) noexcept {
  return ::munmap(address, bytes);
}

int FileCalls::madvise(void* address, std::size_t bytes, int advice) noexcept {
  return ::madvise(address, bytes, advice);
}

int FileCalls::io_uring_queue_init(unsigned entries, io_uring* ring, unsigned flags) noexcept {
  return ::io_uring_queue_init(entries, ring, flags);
}

int FileCalls::io_uring_submit_and_wait_timeout(io_uring* ring, io_uring_cqe** completion,
                                                unsigned count,
                                                __kernel_timespec* max_wait) noexcept {
  return ::io_uring_submit_and_wait_timeout(ring, completion, count, max_wait, nullptr);
}

void FileCalls::io_uring_queue_exit(io_uring* ring) noexcept { ::io_uring_queue_exit(ring); }

FileCalls& FileCalls::real() noexcept {
  static FileCalls calls;
  return calls;
}

}  // namespace planetree::storage
