#pragma once

#include <cstddef>
#include <span>

#include "planetree/contact.h"
#include "planetree/types.h"
#include "query/serve/batch_order.h"

namespace planetree::query {

class ProbeState;

/// Gets pages that the queries of a batch lack from the server of a remote model, before the
/// queries run. Each round gets the first page that each query lacks, with requests at once, so
/// that a batch waits for a round trip for each level of the tree, not for each page.
///
/// threads  that of the probe
class BatchPrefetch {
 public:
  /// Number of queries that are looked at together.
  static constexpr std::size_t kQueries = 256;

  /// probe, queries, order  must outlive this
  /// options                of the batch; `wait` is ignored
  BatchPrefetch(ProbeState& probe, std::span<const Vec3> queries, const BatchOrder& order,
                const QueryOptions& options) noexcept
      : probe_(probe), queries_(queries), order_(order), options_(options) {
    options_.wait = Wait::kNever;
  }

  /// Whether it is of use for a batch: the model is remote, and the queries wait for pages.
  static bool helps(const ProbeState& probe, const QueryOptions& options) noexcept;

  /// Gets the pages of the queries [first, end) of the order, at most kQueries. Does nothing after
  /// a page that the server did not give.
  void run(std::size_t first, std::size_t end) noexcept;

 private:
  static constexpr unsigned kMaxRounds = 6;
  // Pages of one round. The frames and the clusters in memory must hold them.
  static constexpr std::size_t kMaxPages = 64;

  bool run_round(std::size_t first, std::size_t end) noexcept;

  ProbeState& probe_;
  const std::span<const Vec3> queries_;
  const BatchOrder& order_;
  QueryOptions options_;
  bool has_failed_ = false;
};

}  // namespace planetree::query
