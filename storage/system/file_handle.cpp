#include "storage/system/file_handle.h"

#include <fcntl.h>
#include <sys/stat.h>

#include <cerrno>
#include <utility>

#include "storage/system/file_error.h"

namespace planetree::storage {
namespace {

constexpr std::size_t kLineBytes = 64;  // a cache line

// Maximum number of waits for one read: a device may deliver the bytes in several parts.
constexpr unsigned kMaxWaits = 4;

// Pauses without giving up the processor, because another thread could keep it for milliseconds.
void pause_a_little() noexcept {
#if defined(__SSE2__)
  for (int i = 0; i < 8; ++i) __builtin_ia32_pause();
#endif
}

}  // namespace

FileHandle::FileHandle(FileHandle&& other) noexcept
    : calls_(other.calls_), descriptor_(std::exchange(other.descriptor_, -1)) {}

FileHandle& FileHandle::operator=(FileHandle&& other) noexcept {
  if (this != &other) {
    close();
    calls_ = other.calls_;
    descriptor_ = std::exchange(other.descriptor_, -1);
  }
  return *this;
}

FileHandle::~FileHandle() { close(); }

FileHandle FileHandle::open(FileCalls& calls, int directory, const char* path, int flags,
                            mode_t mode) noexcept {
  FileHandle handle;
  handle.calls_ = &calls;
  do {
    handle.descriptor_ = calls.openat(directory, path, flags | O_CLOEXEC, mode);
  } while (handle.descriptor_ < 0 && errno == EINTR);
  return handle;
}

void FileHandle::close() noexcept {
  if (!is_open()) return;
  // close() frees the descriptor even if it fails. Bytes that must be durable were synced before.
  const int kept_errno = errno;
  calls_->close(std::exchange(descriptor_, -1));
  errno = kept_errno;
}

Result<void> FileHandle::read_at(std::uint64_t offset, std::span<std::byte> out,
                                 const char* what) const noexcept {
  while (!out.empty()) {
    const ssize_t count =
        calls_->pread(descriptor_, out.data(), out.size(), static_cast<off_t>(offset));
    if (count < 0) {
      if (errno == EINTR) continue;
      return file_error(errno, FileAction::kRead, what, Error::kNowhere, offset);
    }
    if (count == 0) {
      return make_error(ErrorCode::kTruncated, Error::kNowhere, offset,
                        "the file ends %zu bytes early: it became shorter after it was opened; "
                        "restore it from a copy or build it again",
                        out.size());
    }
    out = out.subspan(static_cast<std::size_t>(count));
    offset += static_cast<std::uint64_t>(count);
  }
  return {};
}

bool FileHandle::try_read(std::uint64_t offset, std::span<std::byte> out,
                          const ReadLimits& terms) const noexcept {
  Poll poll = poll_once(offset, out);
  if (poll.found != Found::kPart) return poll.found == Found::kAll;
  calls_->posix_fadvise(descriptor_, static_cast<off_t>(offset), static_cast<off_t>(out.size()),
                        POSIX_FADV_WILLNEED);
  // The loop is not a function of its own, because the compiler would take it for one without
  // effect and remove the call.
  for (std::size_t at = 0; at < terms.prefetch_for_write.size(); at += kLineBytes)
    __builtin_prefetch(&terms.prefetch_for_write[at], 1);
  const auto end = std::chrono::steady_clock::now() + terms.max_wait;
  // Wait for the last byte, which usually arrives last.
  std::size_t awaited = out.size() - 1;
  for (unsigned i = 0; terms.wait != nullptr && i < kMaxWaits; ++i) {
    const auto waited = terms.wait->wait_until(*calls_, descriptor_, offset + awaited, end);
    if (waited == ReadWait::Outcome::kRefused) break;
    poll = poll_once(offset, out);
    if (poll.found != Found::kPart) return poll.found == Found::kAll;
    if (waited == ReadWait::Outcome::kLate) return false;
    awaited = poll.bytes;
  }
  return poll_until(std::chrono::steady_clock::now() + terms.max_poll, offset, out);
}

bool FileHandle::poll_until(std::chrono::steady_clock::time_point end, std::uint64_t offset,
                            std::span<std::byte> out) const noexcept {
  Poll poll{};
  do {
    pause_a_little();
    poll = poll_once(offset, out);
  } while (poll.found == Found::kPart && std::chrono::steady_clock::now() < end);
  return poll.found == Found::kAll;
}

FileHandle::Poll FileHandle::poll_once(std::uint64_t offset,
                                       std::span<std::byte> out) const noexcept {
  const iovec part{out.data(), out.size()};
  const ssize_t count =
      calls_->preadv2(descriptor_, &part, 1, static_cast<off_t>(offset), RWF_NOWAIT);
  if (count < 0) return {errno == EAGAIN ? Found::kPart : Found::kNever, 0};
  const auto bytes = static_cast<std::size_t>(count);
  if (bytes == out.size()) return {Found::kAll, bytes};
  // A read of 0 bytes means the end of the file.
  return {bytes > 0 ? Found::kPart : Found::kNever, bytes};
}

Result<void> FileHandle::write_at(std::uint64_t offset, std::span<const std::byte> bytes,
                                  const char* what) const noexcept {
  while (!bytes.empty()) {
    const ssize_t count =
        calls_->pwrite(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) {
      // A device that accepts 0 bytes without an error would make this loop endless.
      return file_error(count < 0 ? errno : EIO, FileAction::kWrite, what, Error::kNowhere, offset);
    }
    bytes = bytes.subspan(static_cast<std::size_t>(count));
    offset += static_cast<std::uint64_t>(count);
  }
  return {};
}

Result<std::uint64_t> FileHandle::size_bytes() const noexcept {
  struct stat status;
  if (calls_->fstat(descriptor_, &status) != 0)
    return file_error(errno, FileAction::kRead, "examine the file");
  return static_cast<std::uint64_t>(status.st_size);
}

Result<void> FileHandle::truncate(std::uint64_t bytes) const noexcept {
  int outcome = 0;
  do {
    outcome = calls_->ftruncate(descriptor_, static_cast<off_t>(bytes));
  } while (outcome != 0 && errno == EINTR);
  if (outcome != 0 || calls_->fsync(descriptor_) != 0)
    return file_error(errno, FileAction::kWrite, "cut the file");
  return {};
}

Result<void> FileHandle::sync_data() const noexcept {
  if (calls_->fdatasync(descriptor_) == 0) return {};
  return file_error(errno, FileAction::kWrite, "make the file durable");
}

}  // namespace planetree::storage
