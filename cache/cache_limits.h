#pragma once

#include <cstdint>

#include "planetree/error.h"

namespace planetree::cache {

/// Which page goes when another needs its frame: clock_policy.h, lru_policy.h.
enum class Policy : std::uint8_t { kClock, kLru };

/// How much a PageCache may hold, and of what.
struct CacheLimits {
  std::uint64_t budget_bytes;    ///< hard ceiling for the cache and what the owner reserves
  std::uint32_t page_count;      ///< pages are 0 ... page_count - 1; at least 1
  std::uint32_t frame_bytes;     ///< of a decoded page; 1 ... kMaxFrameBytes
  std::uint32_t max_readers;     ///< readers at one time; 1 ... kMaxReaders
  std::uint64_t reserved_bytes;  ///< what the owner needs out of the same budget
  Policy policy = Policy::kClock;
};

inline constexpr std::uint32_t kMaxFrameBytes = std::uint32_t{1} << 28;
/// The sections noted in limbo take 8 * max_readers^2 bytes: 18 MiB here.
inline constexpr std::uint32_t kMaxReaders = 1536;

/// Refuses limits outside the ranges above, with kBadArgument.
Result<void> check_limits(const CacheLimits& limits) noexcept;

/// Fewest frames with which every fetch is certain to end: one for each place
/// in limbo (each reader's, and pin's), and one to hold a pinned root. Never
/// more than there are pages, since with a frame for each page nothing is ever
/// evicted.
std::uint32_t minimum_frame_count(const CacheLimits& limits) noexcept;

/// All memory a cache of `frame_count` frames takes, and the reserve: what is
/// compared with the budget. Saturates.
std::uint64_t bytes_needed(const CacheLimits& limits, std::uint32_t frame_count) noexcept;

/// The smallest budget create() accepts; `limits.budget_bytes` is not looked at.
std::uint64_t minimum_budget_bytes(const CacheLimits& limits) noexcept;

/// Most frames that fit the budget, at most page_count; 0 if not even one does.
std::uint32_t frames_within_budget(const CacheLimits& limits) noexcept;

}  // namespace planetree::cache
