#include "storage/spill/spill_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cassert>
#include <cerrno>
#include <cstring>
#include <string>
#include <utility>

#include "storage/spill/result_file.h"
#include "storage/system/file_error.h"

namespace planetree::storage {
namespace {

constexpr int kMaxNameAttempts = 100;
constexpr mode_t kMode = 0600;  // other users must not read the data

Error spill_error(const char* what) noexcept { return file_error(errno, FileAction::kWrite, what); }

// For file systems without unnamed files: creates a file with a name and unlinks it at once.
FileHandle open_and_unlink(FileCalls& calls, int directory) {
  static std::atomic<unsigned> counter{0};
  for (int attempt = 0; attempt < kMaxNameAttempts; ++attempt) {
    const std::string name =
        ".planetree-" + std::to_string(::getpid()) + "-" + std::to_string(counter++) + ".spill";
    FileHandle file = FileHandle::open(calls, directory, name.c_str(),
                                       O_CREAT | O_EXCL | O_NOFOLLOW | O_RDWR, kMode);
    if (file.is_open()) {
      // A second attempt covers a transient failure, because nothing else removes the file.
      if (calls.unlinkat(directory, name.c_str(), 0) != 0 &&
          calls.unlinkat(directory, name.c_str(), 0) != 0)
        file.close();
      return file;
    }
    if (errno != EEXIST) break;
  }
  return {};
}

}  // namespace

SpillFile::SpillFile(std::filesystem::path directory, std::uint64_t held_bytes, FileCalls& calls)
    : directory_(std::move(directory)),
      held_bytes_(held_bytes),
      held_(std::make_unique_for_overwrite<std::byte[]>(held_bytes)),
      calls_(calls) {}

SpillFile::SpillFile(FileHandle file, std::uint64_t size_bytes)
    : calls_(file.calls()), own_(std::move(file)), next_(size_bytes) {}

SpillFile::SpillFile(const FileHandle& file) : calls_(file.calls()), file_(&file) {}

std::uint64_t SpillFile::attach(std::shared_ptr<const ResultFile> file) {
  assert(attached_.size() < kMaxAttached);
  attached_.push_back(std::move(file));
  return attached_.size() * kMaxBytes;
}

Result<void> SpillFile::open() {
  if (file_->is_open()) return {};
  const char* const path = directory_.empty() ? "." : directory_.c_str();
  const FileHandle directory = FileHandle::open(calls_, AT_FDCWD, path, O_RDONLY | O_DIRECTORY);
  if (!directory.is_open()) return spill_error("open the directory for temporary files");
  own_ = FileHandle::open(calls_, directory.descriptor(), ".", O_TMPFILE | O_RDWR, kMode);
  const bool unknown = errno == EOPNOTSUPP || errno == EISDIR || errno == EINVAL;
  if (!own_.is_open() && unknown) own_ = open_and_unlink(calls_, directory.descriptor());
  if (!own_.is_open()) return spill_error("create a temporary file");
  return {};
}

Result<std::uint64_t> SpillFile::append(std::span<const std::byte> bytes) {
  const std::uint64_t offset = next_.fetch_add(bytes.size(), std::memory_order_relaxed);
  const std::size_t held = held_part(offset, bytes.size());
  if (held > 0) std::memcpy(&held_[offset], bytes.data(), held);
  if (held == bytes.size()) return offset;
  if (const auto written = write(offset + held, bytes.subspan(held)); !written) {
    failed_ = true;
    return written.error();
  }
  return offset;
}

Result<void> SpillFile::write(std::uint64_t offset, std::span<const std::byte> bytes) {
  std::call_once(opened_once_, [this] {
    if (const auto opened = open(); !opened) open_failure_ = opened.error();
  });
  if (open_failure_) return *open_failure_;
  return file_->write_at(offset, bytes, "write a temporary file");
}

Result<void> SpillFile::read(std::uint64_t offset, std::span<std::byte> out) const {
  if (offset >= kMaxBytes) {
    const auto read = attached_[offset / kMaxBytes - 1]->read(offset % kMaxBytes, out);
    if (!read) failed_ = true;
    return read;
  }
  assert(offset + out.size() <= size_bytes());
  const std::size_t held = held_part(offset, out.size());
  if (held > 0) std::memcpy(out.data(), &held_[offset], held);
  if (held == out.size()) return {};
  const auto read = file_->read_at(offset + held, out.subspan(held), "read a temporary file");
  if (!read) failed_ = true;
  return read;
}

Result<void> SpillFile::sync() {
  // One thread at a time, because the system reports lost bytes only once and every caller must
  // learn of them.
  const std::lock_guard lock(syncing_);
  if (sync_failure_) return *sync_failure_;
  const auto synced = file_->sync_data();
  if (!synced) {
    sync_failure_ = synced.error();
    failed_ = true;
  }
  return synced;
}

}  // namespace planetree::storage
