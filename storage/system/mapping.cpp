#include "storage/system/mapping.h"

#include <sys/mman.h>
#include <unistd.h>

#include <cassert>
#include <cerrno>
#include <cstring>
#include <utility>

#include "storage/system/file_error.h"

namespace planetree::storage {
namespace {

// Makes the system read the range now, so that a bad sector is an error here and not a signal
// later. Returns an error number, or 0 on success and where the system is too old to know the
// advice.
int populate(FileCalls& calls, void* address, std::size_t bytes) noexcept {
#ifdef MADV_POPULATE_READ
  int outcome;
  do {
    outcome = calls.madvise(address, bytes, MADV_POPULATE_READ);
  } while (outcome != 0 && errno == EINTR);
  if (outcome == 0 || errno == EINVAL || errno == ENOSYS) return 0;
  // EFAULT replaces the signal that access to the bytes would have raised.
  return errno == EFAULT ? EIO : errno;
#else
  return 0;
#endif
}

}  // namespace

Mapping::Mapping(Mapping&& other) noexcept
    : calls_(other.calls_),
      address_(std::exchange(other.address_, nullptr)),
      mapped_bytes_(std::exchange(other.mapped_bytes_, 0)),
      bytes_(std::exchange(other.bytes_, {})) {}

Mapping::~Mapping() { unmap(); }

Result<Mapping> Mapping::create(const FileHandle& file, std::uint64_t offset,
                                std::size_t bytes) noexcept {
  assert(file.is_open() && bytes > 0);
  const auto alignment = static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
  const std::size_t before = static_cast<std::size_t>(offset % alignment);
  if (bytes > SIZE_MAX - before) {
    return file_error(ENOMEM, FileAction::kRead, "map the file", Error::kNowhere, offset);
  }
  Mapping mapping;
  mapping.calls_ = &file.calls();
  void* const address = file.calls().mmap(before + bytes, PROT_READ, MAP_SHARED, file.descriptor(),
                                          static_cast<off_t>(offset - before));
  if (address == MAP_FAILED) {
    return file_error(errno, FileAction::kRead, "map the file", Error::kNowhere, offset);
  }
  mapping.address_ = address;
  mapping.mapped_bytes_ = before + bytes;
  if (const int number = populate(file.calls(), address, before + bytes); number != 0) {
    return file_error(number, FileAction::kRead, "read the file", Error::kNowhere, offset);
  }
  mapping.bytes_ = {static_cast<const std::byte*>(address) + before, bytes};
  return mapping;
}

void Mapping::unmap() noexcept {
  if (address_ != nullptr) calls_->munmap(address_, mapped_bytes_);
  address_ = nullptr;
}

Result<void> copy_mapped(const FileHandle& file, std::uint64_t offset,
                         std::span<std::byte> out) noexcept {
  if (out.empty()) return {};
  const Result<Mapping> mapping = Mapping::create(file, offset, out.size());
  if (!mapping) return mapping.error();
  std::memcpy(out.data(), mapping->bytes().data(), out.size());
  return {};
}

}  // namespace planetree::storage
