#pragma once

#include <cstdint>

namespace planetree {

/// How a model chooses the page to evict when a page is read and no frame is free. Answers do not
/// depend on it. See OpenOptions::policy.
enum class EvictionPolicy : std::uint8_t {
  /// A hand passes over the frames in a circle. Each page has a score, which uses raise and the
  /// hand lowers. The first page without score is evicted.
  kClock,
  kLru,  ///< the least recently used page
  /// A queue in the order of reading, over which a hand passes from the oldest to the newest page.
  /// The first page that was not used since the hand last passed it is evicted.
  ///
  /// source  Zhang et al. 2024, "SIEVE is simpler than LRU".
  kSieve,
  /// A small queue of new pages and a main queue of pages that were used several times. Pages that
  /// return soon after they left the small queue enter the main queue.
  ///
  /// source  Yang et al. 2023, "FIFO queues are all you need for cache eviction".
  kS3Fifo,
  /// A queue of new pages, and the pages that returned soon after they left it, of which the least
  /// recently used one is evicted.
  ///
  /// source  Johnson & Shasha 1994, "2Q: a low overhead high performance buffer management
  ///         replacement algorithm".
  kTwoQ,
};

}  // namespace planetree
