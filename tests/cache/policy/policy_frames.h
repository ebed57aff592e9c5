#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "cache/policy/evictor.h"
#include "cache/prefaulted_memory.h"

namespace planetree::cache {

/// An Evictor with its memory, and which page is in which frame.
class PolicyFrames {
 public:
  static constexpr std::uint32_t kNoPage = ~std::uint32_t{0};

  PolicyFrames(EvictionPolicy policy, std::uint32_t frame_count, std::uint32_t page_count)
      : memory_(bytes(policy, frame_count, page_count)),
        tables_(cut(policy, frame_count, page_count, memory_.data())),
        evictor_(policy, tables_),
        pages_(frame_count, kNoPage) {}

  Evictor& evictor() { return evictor_; }
  const PolicyTables& tables() const { return tables_; }
  std::uint32_t frame_count() const { return static_cast<std::uint32_t>(pages_.size()); }
  std::uint32_t page_in(std::uint32_t frame) const { return pages_[frame]; }
  bool has(std::uint32_t page) const { return frame_of(page) != kNoFrame; }

  /// Returns the frame of a page, or kNoFrame.
  std::uint32_t frame_of(std::uint32_t page) const {
    for (std::uint32_t frame = 0; frame < pages_.size(); ++frame)
      if (pages_[frame] == page) return frame;
    return kNoFrame;
  }
  /// Marks the frame of a resident page as used.
  void use(std::uint32_t page, int times = 1) {
    for (int i = 0; i < times; ++i) evictor_.reference_bits().mark(frame_of(page));
  }
  /// Evicts one page and returns it; kNoPage if none is evictable.
  std::uint32_t evict() {
    const std::uint32_t victim = evictor_.choose_victim();
    if (victim == kNoFrame) return kNoPage;
    evictor_.remove(victim);
    return std::exchange(pages_[victim], kNoPage);
  }
  /// Installs a page in the first idle frame and returns the frame. There must be one.
  std::uint32_t install(std::uint32_t page, PageTier tier = PageTier::kLower) {
    const std::uint32_t frame = frame_of(kNoPage);
    evictor_.install(frame, page, tier);
    pages_[frame] = page;
    return frame;
  }
  /// Makes a page resident, as the cache does. Returns the page evicted for it, or kNoPage.
  std::uint32_t read(std::uint32_t page, PageTier tier = PageTier::kLower) {
    const std::uint32_t victim = has(kNoPage) ? kNoPage : evict();
    install(page, tier);
    return victim;
  }
  /// Uses a page if it is resident, else reads it. Returns whether it was resident.
  bool look_up(std::uint32_t page) {
    const bool was_resident = has(page);
    was_resident ? use(page) : static_cast<void>(read(page));
    return was_resident;
  }

 private:
  static PolicyTables cut(EvictionPolicy policy, std::uint32_t frames, std::uint32_t pages,
                          std::byte* base) {
    ArenaLayout layout(base);
    return cut_policy_tables(policy, frames, pages, layout);
  }
  static std::size_t bytes(EvictionPolicy policy, std::uint32_t frames, std::uint32_t pages) {
    ArenaLayout layout(nullptr);
    cut_policy_tables(policy, frames, pages, layout);
    return layout.used_bytes();
  }

  std::vector<std::byte> memory_;
  const PolicyTables tables_;
  Evictor evictor_;
  std::vector<std::uint32_t> pages_;  // indexed by frame
};

}  // namespace planetree::cache
