#include "cache/cache_tables.h"

#include <cassert>
#include <cstddef>
#include <memory>
#include <type_traits>

namespace planetree::cache {
namespace {

/// Cuts arrays off a piece of memory, each on its own cache line. Without
/// memory it only measures, so that measuring and cutting cannot disagree.
class Cutter {
 public:
  explicit Cutter(std::byte* base) noexcept : base_(base) {}

  template <class T>
  std::span<T> cut(std::uint64_t count) noexcept {
    static_assert(std::is_trivially_destructible_v<T>, "nobody runs destructors here");
    static_assert(alignof(T) <= kLineBytes);
    const std::uint64_t start = used_bytes_;
    used_bytes_ += (count * sizeof(T) + kLineBytes - 1) / kLineBytes * kLineBytes;
    if (base_ == nullptr) return {};
    T* first = reinterpret_cast<T*>(base_ + start);
    std::uninitialized_value_construct_n(first, count);
    return {first, count};
  }

  std::uint64_t used_bytes() const noexcept { return used_bytes_; }

 private:
  static constexpr std::uint64_t kLineBytes = 64;

  std::byte* base_;
  std::uint64_t used_bytes_ = 0;
};

CacheTables cut_tables(const CacheLimits& limits, std::uint64_t frame_count,
                       Cutter& cutter) noexcept {
  const std::uint64_t page_count = limits.page_count;
  const std::uint64_t slot_count = limits.max_readers;
  const std::uint64_t owner_count = slot_count + 1;
  CacheTables tables;
  tables.map = cutter.cut<PageMap::Cell>(page_count);
  tables.quarantine_bits = cutter.cut<std::uint64_t>((page_count + 63) / 64);
  tables.scores = cutter.cut<ClockPolicy::Score>(frame_count);
  tables.states = cutter.cut<ClockPolicy::State>(frame_count);
  tables.pages = cutter.cut<std::uint32_t>(frame_count);
  tables.free_frames = cutter.cut<std::uint32_t>(frame_count);
  tables.slots = cutter.cut<ReaderSlot>(slot_count);
  tables.places = cutter.cut<Limbo::Place>(owner_count);
  tables.stamps = cutter.cut<std::uint64_t>(owner_count * slot_count);
  return tables;
}

}  // namespace

std::uint64_t tables_bytes(const CacheLimits& limits, std::uint32_t frame_count) noexcept {
  Cutter cutter(nullptr);
  cut_tables(limits, frame_count, cutter);
  return cutter.used_bytes();
}

CacheTables make_tables(const CacheLimits& limits, std::uint32_t frame_count,
                        const ClaimedMemory& memory) noexcept {
  Cutter cutter(memory.data());
  const CacheTables tables = cut_tables(limits, frame_count, cutter);
  assert(cutter.used_bytes() <= memory.bytes());
  return tables;
}

}  // namespace planetree::cache
