#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>

#include "planetree/contact.h"
#include "planetree/types.h"
#include "query/serve/batch_order.h"

namespace planetree::query {

class ProbeState;

/// Gets pages that the queries of a batch lack from the server of a remote model, before the
/// queries run. Each round gets the first page that each query lacks for its distance and for its
/// side, with requests at once. So a batch waits for a round trip for each level of the trees, not
/// for each page. Of few queries it gets more pages each, and the pages below those with few nodes.
///
/// threads  that of the probe
class BatchPrefetch {
 public:
  /// Maximum of `pages_each`.
  static constexpr std::size_t kMaxPagesEach = 6;
  /// Returns how many pages to get of each query of a batch. Of a single one, the next pages are
  /// got with the first one, so that it need not wait again if that one does not have the nearest
  /// triangle.
  static constexpr std::size_t pages_each(std::size_t queries) noexcept {
    return queries == 1 ? 4 : 1;
  }
  /// Number of queries that are looked at together.
  /// Few, so that the clusters that they need fit in memory.
  static constexpr std::size_t kQueries = 64;

  /// probe, queries, order  must outlive this
  /// options                of the batch; `wait` is ignored
  /// pages_each             maximum number of pages of each query in a round, for its distance and
  ///                        again for its side; 1 to kMaxPagesEach
  /// stop                   ends it after a round when it becomes true; may be null
  BatchPrefetch(ProbeState& probe, std::span<const Vec3> queries, const BatchOrder& order,
                const QueryOptions& options, std::size_t pages_each,
                const std::atomic<bool>* stop = nullptr) noexcept
      : probe_(probe),
        queries_(queries),
        order_(order),
        options_(options),
        pages_each_(pages_each),
        stop_(stop) {
    options_.wait = Wait::kNever;
  }

  /// Whether it is of use for a batch: the model is remote, and the queries wait for pages.
  static bool helps(const ProbeState& probe, const QueryOptions& options) noexcept;

  /// Gets the pages of the queries [first, end) of the order, at most kQueries, for no longer than
  /// the wait limit. Does nothing after a page that the server did not give.
  void run(std::size_t first, std::size_t end) noexcept;
  /// Does the same within the caller's ProbeState::WaitLimit.
  void run_rounds(std::size_t first, std::size_t end) noexcept;

  /// Whether a page did not come in time.
  bool is_late() const noexcept { return is_late_; }
  /// Number of pages that were made resident.
  std::uint32_t loaded_pages() const noexcept { return loaded_pages_; }

 private:
  static constexpr unsigned kMaxRounds = 6;
  // Looks for missing pages in a round. Each but the last one loads pages that take no request.
  static constexpr unsigned kMaxLooks = 12;
  // Pages of one round. The frames and the clusters in memory must hold them.
  static constexpr std::size_t kMaxPages = 64;

  std::size_t find_missing(std::size_t first, std::size_t end,
                           std::span<std::uint32_t> pages) noexcept;
  std::span<std::uint32_t> find_beyond(std::size_t first, std::size_t end,
                                       std::span<std::uint32_t> room) noexcept;
  void request(std::span<const std::uint32_t> pages) const noexcept;
  bool load(std::span<const std::uint32_t> pages) noexcept;
  bool run_round(std::size_t first, std::size_t end) noexcept;

  ProbeState& probe_;
  const std::span<const Vec3> queries_;
  const BatchOrder& order_;
  QueryOptions options_;
  const std::size_t pages_each_;
  const std::atomic<bool>* const stop_;
  bool is_late_ = false;
  std::uint32_t loaded_pages_ = 0;
};

}  // namespace planetree::query
