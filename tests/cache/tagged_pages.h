#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <set>
#include <span>

#include "cache/page_cache.h"

namespace planetree::cache {

/// Pages for tests. Every 8-byte word is a function of its page number and its index, so that a
/// reader can tell whether it holds another page or one that is being overwritten.
class TaggedPages {
 public:
  static std::uint64_t word(std::uint32_t page, std::size_t index) noexcept {
    return (std::uint64_t{page} + 1) * 0x9e3779b97f4a7c15u + index;
  }

  /// Whether all words of a frame are those of `page`.
  static bool matches(const std::byte* frame, std::uint32_t frame_bytes,
                      std::uint32_t page) noexcept {
    for (std::size_t i = 0; i < frame_bytes / sizeof(std::uint64_t); ++i) {
      std::uint64_t found;
      std::memcpy(&found, frame + i * sizeof found, sizeof found);
      if (found != word(page, i)) return false;
    }
    return true;
  }

  /// Writes bytes of no page first, so that a reader that still uses the frame sees them.
  static void write(std::span<std::byte> frame, std::uint32_t page) noexcept {
    std::memset(frame.data(), 0xa5, frame.size());
    for (std::size_t i = 0; i < frame.size() / sizeof(std::uint64_t); ++i) {
      const std::uint64_t value = word(page, i);
      std::memcpy(frame.data() + i * sizeof value, &value, sizeof value);
    }
  }

  /// A FillPage; `context` is a TaggedPages.
  static Result<FillResult> fill(void* context, const FillRequest& request) {
    auto& pages = *static_cast<TaggedPages*>(context);
    const std::uint32_t page = request.page;
    pages.fill_calls_.fetch_add(1, std::memory_order_relaxed);
    write(request.frame, page);
    // Fails after writing, as with a page whose damage shows only when it is decoded.
    if (pages.unreadable_.contains(page)) {
      return make_error(ErrorCode::kDamaged, page, Error::kNowhere, "page %u is damaged", page);
    }
    return FillResult::kFilled;
  }

  void make_unreadable(std::uint32_t page) { unreadable_.insert(page); }
  void make_readable(std::uint32_t page) { unreadable_.erase(page); }
  std::uint64_t fill_calls() const noexcept { return fill_calls_.load(std::memory_order_relaxed); }

 private:
  std::set<std::uint32_t> unreadable_;
  std::atomic<std::uint64_t> fill_calls_{0};
};

/// Returns limits with a budget that gives exactly `frame_count` frames.
inline CacheLimits limits_for_frames(std::uint32_t frame_count, std::uint32_t page_count,
                                     std::uint32_t max_readers, std::uint32_t frame_bytes = 4096,
                                     EvictionPolicy policy = EvictionPolicy::kClock) noexcept {
  CacheLimits limits{0, page_count, frame_bytes, max_readers, 0, policy};
  limits.budget_bytes = bytes_needed(limits, frame_count);
  return limits;
}

/// A small repeatable sequence of pseudo-random numbers.
class Numbers {
 public:
  explicit Numbers(std::uint64_t seed) noexcept : state_(seed) {}

  /// Returns 0 ... limit - 1.
  std::uint32_t below(std::uint32_t limit) noexcept {
    state_ = state_ * 6364136223846793005u + 1442695040888963407u;
    return static_cast<std::uint32_t>((state_ >> 33) % limit);
  }

 private:
  std::uint64_t state_;
};

}  // namespace planetree::cache
