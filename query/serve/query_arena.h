#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include "cache/prefaulted_memory.h"
#include "planetree/error.h"
#include "query/serve/fetch_requests.h"
#include "query/serve/page_trace.h"

namespace planetree::query {

/// The memory that queries touch besides the cache: the state of the model, its side grid and
/// coarse field, and the state, fetch requests and page trace of each probe. It is claimed and
/// prefaulted when a model is opened, so that no query causes a page fault.
class QueryArena {
 public:
  struct Needs {
    std::uint32_t readers = 0;        ///< maximum number of probes, with those of threads
    std::uint64_t model_bytes = 0;    ///< size of the model's state
    std::uint64_t probe_bytes = 0;    ///< size of a probe's state
    std::uint64_t contact_bytes = 0;  ///< memory of each reader for a query for contacts
    std::uint64_t side_grid_bytes = 0;
    std::uint64_t field_bytes = 0;
    std::uint64_t page_trace_capacity = 0;  ///< words per reader; 0: no trace
    std::uint64_t page_count = 0;
  };

  /// The parts of the memory.
  struct Parts {
    std::span<std::byte> model;               ///< aligned to a cache line
    std::span<std::byte> probes;              ///< see probe()
    std::span<FetchRequests> fetch_requests;  ///< indexed by reader
    std::span<std::byte> contacts;            ///< one after another; aligned to a cache line
    std::span<std::byte> side_grid;
    std::span<std::byte> field;    ///< aligned to a cache line
    PageTraces* traces = nullptr;  ///< null without a trace

    /// Returns storage for the state of the probe with a reader index, aligned to a cache line.
    void* probe(std::uint32_t reader) const noexcept {
      return probes.data() + reader * (probes.size() / fetch_requests.size());
    }
  };

  /// Bytes that claim() takes from the budget.
  static std::uint64_t bytes(const Needs& needs) noexcept;
  /// errors  kNoMemory
  static Result<QueryArena> claim(const Needs& needs) noexcept;

  /// Locks the memory, so that the system does not page it out. Returns false if that is refused.
  bool lock() const noexcept { return memory_.lock(); }
  std::uint64_t bytes() const noexcept { return memory_.bytes(); }
  const Parts& parts() const noexcept { return parts_; }

 private:
  QueryArena(cache::PrefaultedMemory memory, const Parts& parts) noexcept
      : memory_(std::move(memory)), parts_(parts) {}

  cache::PrefaultedMemory memory_;
  Parts parts_;
};

}  // namespace planetree::query
