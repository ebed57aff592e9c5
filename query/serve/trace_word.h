#pragma once

#include <bit>
#include <cstdint>

#include "planetree/trace.h"

/// The words of 64 bits in which a page trace waits to be drained.
///
///     bit 63      flag: the page was needed; of an installed page, it is of the upper tier
///     bits 59-62  TraceEvent
///
/// Of kTime and kNumber the other bits are a value. Of the others:
///
///     bit 58      the query waits for pages
///     bit 57      the query is one of a batch
///     bits 54-56  PageAccess::Query
///     bits 32-53  the low bits of the query's number
///     bits 0-31   the page, or a float
namespace planetree::query {

enum class TraceEvent : std::uint8_t {
  kHit,
  kMissed,
  kFetched,
  kInstalled,
  kEvicted,
  kDegraded,  ///< the float is the width
  kMotion,    ///< six words follow: the coordinates of position and velocity
  kBound,     ///< follows kMissed; the float is the squared bound of what the page holds
  kTime,      ///< time of the words from here on
  kNumber,    ///< number of the query that the next word belongs to
};

struct TraceWord {
  static constexpr unsigned kEventShift = 59, kWaitsShift = 58, kBatchShift = 57, kQueryShift = 54,
                            kNumberShift = 32;
  static constexpr unsigned kNumberBits = kQueryShift - kNumberShift;
  static constexpr std::uint64_t kFlag = std::uint64_t{1} << 63;
  static constexpr std::uint64_t kMaxValue = (std::uint64_t{1} << kEventShift) - 1;
  static constexpr unsigned kMotionWords = 7;

  /// The bits 32 to 58 of the words of a query.
  static constexpr std::uint64_t prefix(PageAccess::Query kind, bool waits, bool in_batch,
                                        std::uint64_t number) noexcept {
    constexpr std::uint64_t kNumberMask = (std::uint64_t{1} << kNumberBits) - 1;
    return std::uint64_t{waits} << kWaitsShift | std::uint64_t{in_batch} << kBatchShift |
           static_cast<std::uint64_t>(kind) << kQueryShift | (number & kNumberMask) << kNumberShift;
  }
  static constexpr std::uint64_t of(TraceEvent event, std::uint64_t rest) noexcept {
    return static_cast<std::uint64_t>(event) << kEventShift | rest;
  }

  constexpr TraceEvent event() const noexcept {
    return static_cast<TraceEvent>(bits >> kEventShift & 0xf);
  }
  constexpr bool flag() const noexcept { return (bits & kFlag) != 0; }
  constexpr bool waits() const noexcept { return (bits >> kWaitsShift & 1) != 0; }
  constexpr bool in_batch() const noexcept { return (bits >> kBatchShift & 1) != 0; }
  constexpr PageAccess::Query query() const noexcept {
    return static_cast<PageAccess::Query>(bits >> kQueryShift & 7);
  }
  constexpr std::uint64_t value() const noexcept { return bits & kMaxValue; }
  constexpr std::uint32_t page() const noexcept { return static_cast<std::uint32_t>(bits); }
  constexpr float real() const noexcept { return std::bit_cast<float>(page()); }
  /// The number of the query. It is `base`, the last known one, or up to 2^22 - 1 more.
  constexpr std::uint64_t number(std::uint64_t base) const noexcept {
    constexpr std::uint64_t kNumberMask = (std::uint64_t{1} << kNumberBits) - 1;
    return base + (((bits >> kNumberShift) - base) & kNumberMask);
  }

  std::uint64_t bits = 0;
};

}  // namespace planetree::query
