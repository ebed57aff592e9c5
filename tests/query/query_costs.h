#pragma once

#include <cstdint>
#include <span>

#include "planetree/model.h"
#include "planetree/probe.h"
#include "planetree/types.h"

namespace planetree::query {

/// What asks of Wait::kNever took besides the processor, on the thread that asked. Counted where
/// no sanitizer is in the way: see allocations_are_counted() and locks_are_counted().
struct QueryCosts {
  std::uint64_t queries = 0;
  std::uint64_t degraded = 0;
  std::uint64_t allocations = 0;  ///< of all threads, the model's own among them
  std::uint64_t locks = 0;
  std::uint64_t calls = 0;        ///< of the system
  bool calls_are_counted = true;  ///< false where the system does not let itself be watched
  std::uint64_t faults = 0;       ///< of pages of memory
  std::uint64_t pages_read = 0;   ///< meanwhile, by the model's threads
  std::uint64_t pages_evicted = 0;
  std::uint64_t grown_bytes = 0;        ///< of the process, as the kernel counts, at its most
  std::uint64_t over_budget_bytes = 0;  ///< of the model, by its own count and by the kernel's
};

/// Queries at the places in turn, at once and with no pause, on a thread of its own: distance, side
/// and normal, then the side alone, then a motion. While it does, its calls of the system are
/// trapped.
///
/// warm_up         asks before anything is counted.
/// resident_bytes  of the process before the model was opened: see resident_memory_bytes().
QueryCosts measure_queries(const Model& model, Probe& probe, std::span<const Vec3> points,
                           std::uint64_t warm_up, std::uint64_t queries,
                           std::uint64_t resident_bytes);

/// Memory of this process that is in no file, to the page; calls the system, allocates nothing.
std::uint64_t resident_memory_bytes() noexcept;

}  // namespace planetree::query
