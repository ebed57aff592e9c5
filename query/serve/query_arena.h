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

/// What asks touch besides frames and page map: the model's own facts, the colours of its mask,
/// what each probe remembers and wishes, and its trace. Claimed when a model is opened, so that no
/// ask faults a page in.
class QueryArena {
 public:
  struct Needs {
    std::uint32_t readers = 0;      ///< maximum of probes, those of the model's threads included
    std::uint64_t model_bytes = 0;  ///< of what queries read of the model
    std::uint64_t probe_bytes = 0;  ///< of the state of each probe
    std::uint64_t side_grid_bytes = 0;
    std::uint64_t page_trace_capacity = 0;  ///< of each reader; 0: no trace
    std::uint64_t page_count = 0;
  };

  /// Where things are.
  struct Parts {
    std::span<std::byte> model;               ///< aligned to a cache line
    std::span<std::byte> probes;              ///< see probe()
    std::span<FetchRequests> fetch_requests;  ///< by reader
    std::span<std::byte> side_grid;
    std::span<PageTrace> traces;    ///< by reader, or empty
    std::span<PrefetchMark> marks;  ///< by page, or empty

    /// Storage for the state of the probe with this reader, aligned to a cache line.
    void* probe(std::uint32_t reader) const noexcept {
      return probes.data() + reader * (probes.size() / fetch_requests.size());
    }
  };

  /// All of it: of the budget.
  static std::uint64_t bytes(const Needs& needs) noexcept;
  /// errors  kNoMemory.
  static Result<QueryArena> claim(const Needs& needs) noexcept;

  /// Keeps the system from paging it out; false where that is not allowed.
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
