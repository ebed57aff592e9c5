#include "cache/prefaulted_memory.h"

#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <cinttypes>
#include <limits>
#include <utility>

namespace planetree::cache {
namespace {

static_assert(sizeof(std::size_t) == sizeof(std::uint64_t), "budgets are 64-bit sizes");

constexpr std::uint64_t kHugePageBytes = std::uint64_t{2} << 20;
/// A claim of at least this size takes at least a huge page.
constexpr std::uint64_t kMinHugeBytes = kHugePageBytes / 4 * 3;

std::uint64_t system_page_bytes() noexcept {
  static const auto bytes = static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
  return bytes;
}

std::byte* map_anonymous(std::uint64_t bytes) noexcept {
  void* address =
      ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  return address == MAP_FAILED ? nullptr : static_cast<std::byte*>(address);
}

/// Maps memory aligned to huge pages. The kernel uses huge pages only for aligned ranges of 2 MiB,
/// and older kernels do not align mappings. So this maps more than requested and unmaps both ends.
std::byte* map_huge_aligned(std::uint64_t bytes) noexcept {
  if (bytes > std::numeric_limits<std::uint64_t>::max() - kHugePageBytes) return nullptr;
  std::byte* start = map_anonymous(bytes + kHugePageBytes);
  if (start == nullptr) return nullptr;
  const std::uint64_t past = reinterpret_cast<std::uintptr_t>(start) % kHugePageBytes;
  const std::uint64_t skipped = past == 0 ? 0 : kHugePageBytes - past;
  if (skipped != 0) ::munmap(start, skipped);
  ::munmap(start + skipped + bytes, kHugePageBytes - skipped);
  // Failure does not matter: where huge pages are disabled, small ones are used.
  ::madvise(start + skipped, bytes, MADV_HUGEPAGE);
  return start + skipped;
}

/// Backs every page with physical memory. Returns false if the system has too little.
bool populate(std::byte* data, std::uint64_t bytes) noexcept {
#ifdef MADV_POPULATE_WRITE
  int outcome = 0;
  do {
    outcome = ::madvise(data, bytes, MADV_POPULATE_WRITE);
  } while (outcome != 0 && errno == EINTR);
  if (outcome == 0) return true;
  if (errno != EINVAL) return false;
#endif
  // Kernels before 5.14 do not know MADV_POPULATE_WRITE: write to each page instead, what is there.
  for (std::uint64_t at = 0; at < bytes; at += system_page_bytes()) {
    auto* const byte = static_cast<volatile std::byte*>(data + at);
    *byte = *byte;
  }
  return true;
}

Error refused(std::uint64_t bytes) noexcept {
  return make_error(ErrorCode::kNoMemory, Error::kNowhere, Error::kNowhere,
                    "the system refused %" PRIu64
                    " bytes of memory: lower the memory budget or free memory",
                    bytes);
}

}  // namespace

std::uint64_t PrefaultedMemory::claimed_bytes(std::uint64_t bytes) noexcept {
  const std::uint64_t last = system_page_bytes() - 1;
  // Saturates instead of wrapping to a small number.
  if (bytes > std::numeric_limits<std::uint64_t>::max() - last) return bytes;
  const std::uint64_t rounded = (bytes + last) & ~last;
  return rounded >= kMinHugeBytes ? std::max(rounded, kHugePageBytes) : rounded;
}

Result<PrefaultedMemory> PrefaultedMemory::claim(std::uint64_t bytes) noexcept {
  assert(bytes != 0);
  const std::uint64_t rounded = claimed_bytes(bytes);
  std::byte* data = rounded >= kHugePageBytes ? map_huge_aligned(rounded) : map_anonymous(rounded);
  if (data == nullptr) return refused(rounded);
  PrefaultedMemory memory(data, rounded);
  if (!populate(data, rounded)) return refused(rounded);
  return memory;
}

Result<PrefaultedMemory> PrefaultedMemory::reserve(std::uint64_t bytes) noexcept {
  assert(bytes != 0);
  const std::uint64_t rounded = claimed_bytes(bytes);
  // Without access, so that it counts as memory nowhere, not even where the system overcommits
  // none.
  void* const address = ::mmap(nullptr, rounded, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (address == MAP_FAILED) return refused(rounded);
  // A huge page would back more than commit() asks for.
  ::madvise(address, rounded, MADV_NOHUGEPAGE);
  return PrefaultedMemory(static_cast<std::byte*>(address), rounded);
}

Result<void> PrefaultedMemory::commit(std::uint64_t offset, std::uint64_t bytes,
                                      bool is_locked) const noexcept {
  assert(offset + bytes <= bytes_);
  const std::uint64_t last = system_page_bytes() - 1;
  const std::uint64_t begin = offset & ~last;
  const std::uint64_t end = (offset + bytes + last) & ~last;
  if (::mprotect(data_ + begin, end - begin, PROT_READ | PROT_WRITE) != 0 ||
      !populate(data_ + begin, end - begin))
    return refused(end - begin);
  if (is_locked) ::mlock(data_ + begin, end - begin);
  return {};
}

void PrefaultedMemory::discard(std::uint64_t offset, std::uint64_t bytes) const noexcept {
  assert(offset + bytes <= bytes_);
  const std::uint64_t last = system_page_bytes() - 1;
  const std::uint64_t begin = (offset + last) & ~last;
  const std::uint64_t end = (offset + bytes) & ~last;
  if (begin >= end) return;
  ::munlock(data_ + begin, end - begin);
  ::madvise(data_ + begin, end - begin, MADV_DONTNEED);
}

bool PrefaultedMemory::lock() const noexcept { return ::mlock(data_, bytes_) == 0; }

PrefaultedMemory::PrefaultedMemory(PrefaultedMemory&& other) noexcept
    : data_(std::exchange(other.data_, nullptr)), bytes_(std::exchange(other.bytes_, 0)) {}

PrefaultedMemory& PrefaultedMemory::operator=(PrefaultedMemory&& other) noexcept {
  std::swap(data_, other.data_);
  std::swap(bytes_, other.bytes_);
  return *this;
}

PrefaultedMemory::~PrefaultedMemory() {
  if (data_ != nullptr) ::munmap(data_, bytes_);
}

}  // namespace planetree::cache
