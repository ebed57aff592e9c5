#include "cache/cache_memory.h"

#include <algorithm>
#include <cassert>
#include <limits>

#include "cache/frame_pool.h"
#include "cache/page_cache.h"
#include "cache/prefaulted_memory.h"

namespace planetree::cache {
namespace {

/// Size of the PageCache object and of the allocator's header beside it, rounded up.
constexpr std::uint64_t kObjectBytes = 2048;
static_assert(sizeof(PageCache) + 64 <= kObjectBytes);

Error out_of_range(const char* name, std::uint32_t value, std::uint32_t maximum) noexcept {
  return make_error(ErrorCode::kBadArgument, Error::kNowhere, Error::kNowhere,
                    "%s is %u: choose a value from 1 to %u", name, value, maximum);
}

}  // namespace

Result<void> check_limits(const CacheLimits& limits) noexcept {
  constexpr std::uint32_t kMaxPages = kNoFrame - 1;
  if (limits.page_count < 1 || limits.page_count > kMaxPages) {
    return out_of_range("page_count", limits.page_count, kMaxPages);
  }
  if (limits.frame_bytes < 1 || limits.frame_bytes > kMaxFrameBytes) {
    return out_of_range("frame_bytes", limits.frame_bytes, kMaxFrameBytes);
  }
  if (limits.max_readers < 1 || limits.max_readers > kMaxReaders) {
    return out_of_range("max_probes", limits.max_readers, kMaxReaders);
  }
  return {};
}

std::uint32_t minimum_frame_count(const CacheLimits& limits) noexcept {
  if (limits.is_shared) return limits.max_readers + 1;
  return std::min(limits.used_pages(), limits.max_readers + 2);
}

std::uint64_t bytes_needed(const CacheLimits& limits, std::uint32_t frame_count) noexcept {
  // Within checked limits these sums stay below 2^61.
  const std::uint64_t own_bytes =
      kObjectBytes + PrefaultedMemory::claimed_bytes(tables_bytes(limits, frame_count)) +
      PrefaultedMemory::claimed_bytes(frame_count * FramePool::stride_bytes(limits.frame_bytes));
  constexpr std::uint64_t kMax = std::numeric_limits<std::uint64_t>::max();
  return limits.reserved_bytes > kMax - own_bytes ? kMax : own_bytes + limits.reserved_bytes;
}

std::uint64_t minimum_budget_bytes(const CacheLimits& limits) noexcept {
  return bytes_needed(limits, minimum_frame_count(limits));
}

std::uint32_t frames_within_budget(const CacheLimits& limits) noexcept {
  // Several roundings make the bytes a step function of the frame count. Bisecting the range
  // [fits, fits_not) is simpler than inverting it.
  std::uint32_t fits = 0;
  std::uint32_t fits_not = limits.used_pages() + 1;
  while (fits_not - fits > 1) {
    const std::uint32_t middle = fits + (fits_not - fits) / 2;
    (bytes_needed(limits, middle) <= limits.budget_bytes ? fits : fits_not) = middle;
  }
  return fits;
}

namespace {

// Lays out arrays in memory that is all 0 and may not be backed yet, without touching it. Each
// begins on a system page of its own, so that a part of one can be backed by itself.
class UntouchedLayout {
 public:
  explicit UntouchedLayout(std::byte* base) noexcept : base_(base) {}

  template <class T>
  std::span<T> cut(std::uint64_t count) noexcept {
    const std::uint64_t start = used_bytes_;
    used_bytes_ += PrefaultedMemory::claimed_bytes(count * sizeof(T));
    if (base_ == nullptr) return {};
    return {reinterpret_cast<T*>(base_ + start), count};
  }
  std::uint64_t used_bytes() const noexcept { return used_bytes_; }

 private:
  std::byte* base_;
  std::uint64_t used_bytes_ = 0;
};

template <class PageLayout>
CacheTables cut_tables(const CacheLimits& limits, std::uint64_t frame_count, ArenaLayout& layout,
                       PageLayout& page_layout) noexcept {
  const std::uint64_t page_count = limits.page_count;
  const std::uint64_t slot_count = limits.max_readers;
  const std::uint64_t fetcher_count = slot_count + 1;
  CacheTables tables;
  tables.map = page_layout.template cut<PageMap::Cell>(page_count);
  tables.quarantine_bits = page_layout.template cut<std::uint64_t>((page_count + 63) / 64);
  tables.policy = cut_policy_tables(limits.policy, frame_count, page_count, layout, page_layout);
  tables.pages = layout.cut<std::uint32_t>(frame_count);
  tables.free_frames = layout.cut<std::uint32_t>(frame_count);
  tables.slots = layout.cut<ReaderSlot>(slot_count);
  tables.entries = layout.cut<Limbo::Entry>(fetcher_count);
  tables.stamps = layout.cut<std::uint64_t>(fetcher_count * slot_count);
  tables.in_flight_reads = layout.cut<InFlightRead>(fetcher_count);
  return tables;
}

}  // namespace

std::uint64_t page_tables_bytes(const CacheLimits& limits, std::uint64_t page_count) noexcept {
  CacheLimits of_pages = limits;
  of_pages.page_count = static_cast<std::uint32_t>(page_count);
  ArenaLayout layout(nullptr);
  UntouchedLayout page_layout(nullptr);
  cut_tables(of_pages, 0, layout, page_layout);
  return page_layout.used_bytes();
}

std::uint64_t tables_bytes(const CacheLimits& limits, std::uint32_t frame_count) noexcept {
  ArenaLayout layout(nullptr);
  UntouchedLayout page_layout(nullptr);
  if (limits.is_shared)
    cut_tables(limits, frame_count, layout, page_layout);
  else
    cut_tables(limits, frame_count, layout, layout);
  return layout.used_bytes();
}

CacheTables make_tables(const CacheLimits& limits, std::uint32_t frame_count,
                        const PrefaultedMemory& memory,
                        const PrefaultedMemory* page_memory) noexcept {
  ArenaLayout layout(memory.data());
  CacheTables tables;
  if (limits.is_shared) {
    UntouchedLayout page_layout(page_memory->data());
    tables = cut_tables(limits, frame_count, layout, page_layout);
    assert(page_layout.used_bytes() <= page_memory->bytes());
  } else {
    tables = cut_tables(limits, frame_count, layout, layout);
  }
  assert(layout.used_bytes() <= memory.bytes());
  return tables;
}

}  // namespace planetree::cache
