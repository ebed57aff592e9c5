#pragma once

#include <cstdint>
#include <span>

#include "planetree/model.h"
#include "planetree/probe.h"
#include "planetree/types.h"

namespace planetree::query {

/// Costs of real-time queries besides processor time, on the thread that makes them. Counted only
/// in builds without sanitizers: see allocations_are_counted() and locks_are_counted().
struct QueryCosts {
  std::uint64_t queries = 0;
  std::uint64_t degraded = 0;
  std::uint64_t allocations = 0;  ///< of all threads, including the model's own
  std::uint64_t locks = 0;
  std::uint64_t calls = 0;        ///< system calls
  bool calls_are_counted = true;  ///< false where the system does not support trapping
  std::uint64_t faults = 0;       ///< page faults
  std::uint64_t pages_read = 0;   ///< by the model's threads during the queries
  std::uint64_t pages_evicted = 0;
  std::uint64_t grown_bytes = 0;        ///< maximum growth of the process, as the kernel counts
  std::uint64_t over_budget_bytes = 0;  ///< of the model, by its own count and by the kernel's
};

/// Queries the points in turn, without pause, on a thread of its own: distance, side and normal,
/// then the side alone, then a motion. Every eighth point also has one query of each other kind:
/// contacts, sets of triangles, rays and a moving ball. The system calls of that thread are trapped
/// meanwhile.
///
/// warm_up         number of queries before counting starts
/// resident_bytes  of the process before the model was opened: see resident_memory_bytes()
QueryCosts measure_queries(const Model& model, Probe& probe, std::span<const Vec3> points,
                           std::uint64_t warm_up, std::uint64_t queries,
                           std::uint64_t resident_bytes);

/// Anonymous memory of this process, exact to the page. Makes system calls, allocates nothing.
std::uint64_t resident_memory_bytes() noexcept;

}  // namespace planetree::query
